#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"

namespace scree {

/// Of a place from the box of an obstacle in the horizontal plane, metres; 0 inside.
double distance_to_box(const Obstacle& obstacle, const Eigen::Vector3d& place);

/// Joins obstacles of one kind that are pieces of one thing: shadows and the gaps between rings
/// break slivers off a rock, and a ditch into parts along its edge. The piece with the most points
/// stays, with a box that holds the others and the lowest of their ids. List after list: what was
/// found to be one thing in most of the last lists, by its ids, stays one in those where it looks
/// apart.
class Pieces {
public:
  explicit Pieces(std::size_t max_obstacles);

  /// The obstacles come out by their points, most first.
  void join(FixedVector<Obstacle>& obstacles);

private:
  struct Bond {
    std::int64_t one, other;  ///< ids
    int strength;
    bool is_asked;  ///< in this list
  };
  bool renew(std::int64_t one, std::int64_t other, bool is_piece);

  FixedVector<Bond> bonds_;
  FixedVector<std::int64_t> wholes_;  // ids of those kept so far, as they came in
};

/// Of a rock and a hole whose middle lies in the rock's box takes out the less sure one: the hole
/// is what the rock hides, or the rock was the hole's far rim. The order stays.
void keep_the_surer(FixedVector<Obstacle>& obstacles);

}  // namespace scree
