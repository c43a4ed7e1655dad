#pragma once

#include <cstdint>

// Spans of time, in the nanoseconds that every stamp counts.
namespace scree {

inline constexpr std::int64_t kMicrosecond = 1'000;
inline constexpr std::int64_t kMillisecond = 1'000'000;
inline constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace scree
