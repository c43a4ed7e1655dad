#pragma once

#include <array>
#include <cstddef>

namespace scree {

/// F1-F5 of the paper (section 3.2), in this order. Heights in metres above the ground around the
/// cluster; F4 and F5 count points.
enum Feature : std::size_t { mean_height, max_height, min_height, acute_count, obtuse_count };
inline constexpr std::size_t kFeatures = 5;
using Features = std::array<float, kFeatures>;

}  // namespace scree
