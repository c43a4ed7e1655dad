#pragma once

#include <chrono>
#include <cstdint>

namespace scree {

/// For durations: never set.
inline std::int64_t steady_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The host's clock, nanoseconds since the UNIX epoch, as the kernel stamps datagrams.
inline std::int64_t host_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace scree
