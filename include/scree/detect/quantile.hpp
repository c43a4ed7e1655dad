#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace scree {

/// The value below which this share of them lies. Changes their order. @pre there are some, share
/// from 0 to below 1
inline float quantile(std::span<float> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace scree
