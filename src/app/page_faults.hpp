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

/// The page faults of each thread of this process, the oldest thread first, as the kernel counts
/// them in /proc/PID/task/TID/stat (proc(5)). The threads do nothing for it. Without /proc the
/// result is empty.
std::vector<PageFaults> page_faults(const std::filesystem::path& threads = "/proc/self/task");

}  // namespace scree
