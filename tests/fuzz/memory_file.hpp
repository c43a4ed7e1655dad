#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "scree/core/descriptor.hpp"

namespace scree::fuzz {

/// A file of these bytes in memory, for readers that take a name.
class MemoryFile {
public:
  MemoryFile(const std::uint8_t* bytes, std::size_t size) : file_(memfd_create("fuzz", 0)) {
    if (write(file_.get(), bytes, size) != static_cast<ssize_t>(size)) std::abort();
    name_ = "/proc/self/fd/" + std::to_string(file_.get());
  }
  std::filesystem::path name() const { return name_; }

private:
  Descriptor file_;
  std::string name_;
};

/// A property of the program that does not hold is a finding as a fault of memory is.
inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace scree::fuzz
