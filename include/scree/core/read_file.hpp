#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// All bytes of a file. One sentence that names it where it cannot be read, has no end (a FIFO, a
/// terminal, /dev/zero), or is longer than `most` bytes.
inline Result<std::string> read_file(const std::filesystem::path& file, std::uintmax_t most) {
  const auto refuse = [&](const std::string& reason) {
    return fail("cannot read " + file.string() + ": " + reason);
  };
  // Without O_NONBLOCK a FIFO that nobody writes to would hold us up already here.
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (!opened.is_open() || fstat(opened.get(), &status) != 0) return refuse(std::strerror(errno));
  if (S_ISDIR(status.st_mode)) return refuse("it is a folder");
  if (!S_ISREG(status.st_mode)) return refuse("it is no regular file: copy it into one");

  std::string bytes;
  std::array<char, 1 << 16> part{};
  while (bytes.size() <= most) {
    const ssize_t size = read(opened.get(), part.data(), part.size());
    if (size < 0 && errno != EINTR) return refuse(std::strerror(errno));
    if (size == 0) return bytes;
    if (size > 0) bytes.append(part.data(), static_cast<std::size_t>(size));
  }
  return refuse("it is longer than " + std::to_string(most) + " bytes");
}

}  // namespace scree
