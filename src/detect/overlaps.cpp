#include "scree/detect/overlaps.hpp"

#include <algorithm>
#include <utility>

#include "scree/detect/obstacle_box.hpp"

namespace scree {
namespace {

/// A step or a wall is longer than the rim of a hole in front of it.
bool may_be_rim(const Obstacle& rock, const Obstacle& hole) {
  constexpr double kLonger = 2.5;  // times as long as the hole
  return rock.extent.x() <= kLonger * hole.extent.x();
}

}  // namespace

void resolve_overlaps(FixedVector<Obstacle>& obstacles) {
  const auto is_outdone = [&](const Obstacle& one) {
    return std::ranges::any_of(obstacles, [&](const Obstacle& other) {
      if (other.kind == one.kind) return false;
      const bool is_hole = one.kind == ObstacleKind::negative;
      const Obstacle &rock = is_hole ? other : one, &hole = is_hole ? one : other;
      if (distance_to_box(rock, hole.center) > 0) return false;
      if (is_hole) return hole.confidence <= rock.confidence;
      return rock.confidence < hole.confidence && may_be_rim(rock, hole);
    });
  };
  std::size_t kept = 0;
  // Swapped, not moved: none may be missing from the list while it is asked.
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    if (!is_outdone(obstacles[i])) std::swap(obstacles[kept++], obstacles[i]);
  }
  obstacles.resize(kept);
}

}  // namespace scree
