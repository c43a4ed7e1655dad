#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scree/core/descriptor.hpp"

namespace scree {

/// Page faults of a thread since its start.
struct PageFaults {
  std::int64_t minor = 0;  ///< served from memory
  std::int64_t major = 0;  ///< that had to wait for a disk
};

/// Those in a thread's line of the kernel, "TID (NAME) STATE ..." (proc(5), /proc/PID/stat);
/// nothing where it is no such line.
std::optional<PageFaults> page_faults_in(std::string_view line);

/// A thread's page faults as the kernel counts them, for any thread. Reading takes no memory.
class ThreadPageFaults {
public:
  /// To be called once, by the thread itself.
  void open();
  /// Nothing before open(), and without /proc.
  std::optional<PageFaults> read() const;

private:
  Descriptor file_;
  std::atomic<bool> is_open_{false};
};

}  // namespace scree
