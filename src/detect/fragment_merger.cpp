#include "scree/detect/fragment_merger.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

#include "scree/detect/enclosing_polygon.hpp"
#include "scree/detect/obstacle_box.hpp"

namespace scree {
namespace {

/// The middle and the size of the interval that holds two.
std::pair<double, double> hull(double low_a, double high_a, double low_b, double high_b) {
  const double low = std::min(low_a, low_b), high = std::max(high_a, high_b);
  return {(low + high) / 2, high - low};
}

/// Makes one obstacle of both. Its box keeps its direction, or turns by a quarter where the other
/// side is longer now.
void extend(Obstacle& whole, const Obstacle& fragment) {
  const auto outline = corners_of(fragment);
  Eigen::Vector2d low = in_box_frame(whole, outline[0]), high = low;
  for (const Eigen::Vector3d& corner : outline) {
    low = low.cwiseMin(in_box_frame(whole, corner));
    high = high.cwiseMax(in_box_frame(whole, corner));
  }
  const Eigen::Vector3d half = whole.extent / 2;
  const auto [along, length] = hull(-half.x(), half.x(), low.x(), high.x());
  const auto [across, width] = hull(-half.y(), half.y(), low.y(), high.y());
  const double up = fragment.center.z() - whole.center.z(), half_up = fragment.extent.z() / 2;
  const auto [middle, tall] = hull(-half.z(), half.z(), up - half_up, up + half_up);
  const double cosine = std::cos(whole.yaw), sine = std::sin(whole.yaw);
  whole.center +=
      Eigen::Vector3d(cosine * along - sine * across, sine * along + cosine * across, middle);
  whole.extent = {length, width, tall};
  if (length < width) {
    constexpr double kQuarter = std::numbers::pi / 2;
    std::swap(whole.extent.x(), whole.extent.y());
    whole.yaw += whole.yaw > 0 ? -kQuarter : kQuarter;
  }
  if (std::abs(fragment.height) > std::abs(whole.height)) whole.height = fragment.height;
  whole.points += fragment.points;
  whole.footprint = enclosing_polygon(whole.footprint, fragment.footprint);
  whole.id = std::min(whole.id, fragment.id);
}

/// Whether the box of both holds little more than the two. A ditch and a pit beside its end do not
/// fill one: it would hold the ground in the corner between them.
bool fill_a_box(const Obstacle& a, const Obstacle& b) {
  constexpr double kMargin = 0.3;  // metres around each in all
  const auto area = [](const Obstacle& box, double margin) {
    return (box.extent.x() + margin) * (box.extent.y() + margin);
  };
  Obstacle both = a;
  extend(both, b);
  return area(both, 0) <= area(a, kMargin) + area(b, kMargin);
}

/// Whether two obstacles may be parts of a bank, a log or a facade: they are as high, one of them
/// is long, and the smaller is no small thing at the foot of the other.
bool may_be_parts(const Obstacle& whole, const Obstacle& part) {
  constexpr double kLong = 1, kSlender = 3;        // metres; times as long as wide
  constexpr double kAcross = 0.5, kAsHigh = 0.75;  // shares of width and height
  const Obstacle& longer = whole.extent.x() >= part.extent.x() ? whole : part;
  const double one = std::abs(whole.height), other = std::abs(part.height);
  return longer.extent.x() >= std::max(kLong, kSlender * longer.extent.y()) &&
         part.extent.x() >= kAcross * whole.extent.y() &&
         std::min(one, other) >= kAsHigh * std::max(one, other);
}

bool is_fragment(const Obstacle& whole, const Obstacle& fragment) {
  if (whole.kind != fragment.kind) return false;
  constexpr double kFarthest = 3;  // metres
  const double distance = distance_between_boxes(whole, fragment);
  if (distance > kFarthest) return false;

  constexpr std::uint32_t kLarger = 3;  // times as many points
  const bool is_inside = distance_to_box(whole, fragment.center) <= 0;
  if (is_inside && whole.points > kLarger * fragment.points) return true;
  constexpr double kNear = 0.5, kSliver = 0.15;  // metres
  const bool is_sliver = fragment.extent.y() <= kSliver;
  const bool is_hole = fragment.kind == ObstacleKind::negative;
  const bool is_part = (is_hole || may_be_parts(whole, fragment)) && fill_a_box(whole, fragment);
  if (distance <= kNear && (is_sliver || is_part)) return true;

  // Parts of a wall lie on one line, and no further apart than what is known of it is long: a post
  // and a board are two.
  constexpr double kThin = 0.12;    // metres
  constexpr double kInLine = 0.99;  // cosine of the angle between the wall and the way to the part
  const Eigen::Vector2d to = in_box_frame(whole, fragment.center);
  return whole.extent.y() <= kThin && distance <= whole.extent.x() &&
         std::abs(to.x()) >= kInLine * to.norm();
}

}  // namespace

FragmentMerger::FragmentMerger(std::size_t max_obstacles)
    : bonds_(max_obstacles), kept_(max_obstacles) {}

void FragmentMerger::merge(FixedVector<Obstacle>& obstacles) {
  std::sort(obstacles.begin(), obstacles.end(), [](const Obstacle& a, const Obstacle& b) {
    return a.points != b.points ? a.points > b.points : a.id < b.id;
  });
  weaken_unasked_bonds();
  kept_.clear();
  for (const Obstacle& obstacle : obstacles) {
    std::size_t i = 0;
    while (i < kept_.size() &&
           !(obstacles[i].kind == obstacle.kind &&
             update_bond(kept_[i], obstacle.id, is_fragment(obstacles[i], obstacle)))) {
      ++i;
    }
    if (i < kept_.size()) {
      extend(obstacles[i], obstacle);
    } else {
      obstacles[i] = obstacle;
      kept_.push_back(obstacle.id);
    }
  }
  obstacles.resize(kept_.size());
}

/// A bond that the last list did not ask for has lost one of its two obstacles.
void FragmentMerger::weaken_unasked_bonds() {
  std::size_t lasting = 0;
  for (Bond& bond : bonds_) {
    if (!bond.is_asked) --bond.strength;
    bond.is_asked = false;
    if (bond.strength > 0) bonds_[lasting++] = bond;
  }
  bonds_.resize(lasting);
}

/// @param is_fragment whether the two look like one thing in this list
/// @return whether they are one, by this list and the last ones
bool FragmentMerger::update_bond(std::int64_t one, std::int64_t other, bool is_fragment) {
  constexpr int kStrongest = 4;  // lists more that speak for it than against it
  const auto bond = std::ranges::find_if(bonds_, [&](const Bond& each) {
    return each.one == std::min(one, other) && each.other == std::max(one, other);
  });
  if (bond == bonds_.end()) {
    // Where there is no room the two are merged all the same, by what is seen.
    if (is_fragment) bonds_.push_back({std::min(one, other), std::max(one, other), 1, true});
    return is_fragment;
  }
  bond->is_asked = true;
  bond->strength = std::clamp(bond->strength + (is_fragment ? 1 : -1), 0, kStrongest);
  return bond->strength > 0;
}

}  // namespace scree
