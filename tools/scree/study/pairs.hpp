#pragma once

#include <cstddef>

#include "scoring/matching.hpp"
#include "training/worlds.hpp"

namespace scree::cli {

/// Pairs of obstacles 0.3-0.6 m apart, and how many came out as two of the right kinds.
struct Pairs {
  std::size_t all = 0, parted = 0;

  /// @param comparison of the world's truth with one list
  void add(const CloudWorld& world, const Comparison& comparison);
  double share_parted() const;  ///< NaN without pairs
};

}  // namespace scree::cli
