#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"

namespace scree {

/// Merges obstacles of one kind that are fragments of one thing: shadows and the gaps between rings
/// break slivers off a rock, and a ditch, a bank or a facade into parts along it. The fragment with
/// the most points stays, with a box that holds the others and the lowest of their ids. What was
/// one thing in most of the last lists, by its ids, stays one in a list where it looks apart.
class FragmentMerger {
public:
  explicit FragmentMerger(std::size_t max_obstacles);

  /// Merges those of the next list. The obstacles come out by their points, most first.
  void merge(FixedVector<Obstacle>& obstacles);

private:
  /// Two obstacles that were one thing lately.
  struct Bond {
    std::int64_t one, other;  ///< ids
    int strength;             ///< lists that spoke for it, less those against it
    bool is_asked;            ///< in this list
  };
  void weaken_unasked_bonds();
  bool update_bond(std::int64_t one, std::int64_t other, bool is_fragment);

  FixedVector<Bond> bonds_;
  FixedVector<std::int64_t> kept_;  // ids, as they came in, of the obstacles kept so far
};

}  // namespace scree
