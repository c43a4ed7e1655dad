#include "scree/app/memory_cap.hpp"

#include <spdlog/fmt/fmt.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace scree {
namespace {

std::uint64_t available() {
  std::ifstream file("/proc/meminfo");
  for (std::string name; file >> name;) {
    std::uint64_t kilobytes = 0;
    if (name == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024;
  }
  // A service does not see that file (ProcSubset=pid).
  struct sysinfo computer {};
  if (sysinfo(&computer) != 0) return std::numeric_limits<std::uint64_t>::max();
  return std::uint64_t{computer.totalram} * computer.mem_unit;
}

}  // namespace

std::uint64_t memory_taken() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  file >> pages;
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t memory_left() {
  std::uint64_t left = available();
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const std::uint64_t taken = memory_taken();
    left = std::min<std::uint64_t>(left, limit.rlim_cur > taken ? limit.rlim_cur - taken : 0);
  }
  return left;
}

MemoryCap::MemoryCap() : left_(memory_left()) {
  getrlimit(RLIMIT_AS, &before_);
  const rlimit cap{std::min<rlim_t>(before_.rlim_cur, memory_taken() + left_), before_.rlim_max};
  setrlimit(RLIMIT_AS, &cap);
}

MemoryCap::~MemoryCap() {
  setrlimit(RLIMIT_AS, &before_);
}

std::string MemoryCap::sentence() const {
  return fmt::format(
      "the memory that the settings ask for is not there, {:.2f} GB are left: the keys of [memory] "
      "say how much is taken",
      static_cast<double>(left_) * 1e-9);
}

}  // namespace scree
