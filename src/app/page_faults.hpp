#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// Page faults of a thread since its start.
struct PageFaults {
  std::string thread;
  std::int64_t minor = 0;  ///< served from memory
  std::int64_t major = 0;  ///< that had to wait for a disk
};

/// Those of each thread of this process, the oldest first, as the kernel counts them: proc(5),
/// /proc/PID/task/TID/stat. The threads themselves do nothing for it. Empty where there is no
/// /proc.
std::vector<PageFaults> page_faults(const std::filesystem::path& threads = "/proc/self/task");

}  // namespace scree
