#include "scree/detect/pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <utility>

namespace scree {
namespace {

/// In the frame of a box: along its length, and across.
Eigen::Vector2d in_box(const Obstacle& box, const Eigen::Vector3d& place) {
  const Eigen::Vector2d to = (place - box.center).head<2>();
  const double cosine = std::cos(box.yaw), sine = std::sin(box.yaw);
  return {cosine * to.x() + sine * to.y(), cosine * to.y() - sine * to.x()};
}

std::array<Eigen::Vector3d, 4> corners(const Obstacle& box) {
  const Eigen::Vector3d along(std::cos(box.yaw), std::sin(box.yaw), 0);
  const Eigen::Vector3d half_length = box.extent.x() / 2 * along;
  const Eigen::Vector3d half_width = box.extent.y() / 2 * Eigen::Vector3d(-along.y(), along.x(), 0);
  return {box.center + half_length + half_width, box.center + half_length - half_width,
          box.center - half_length + half_width, box.center - half_length - half_width};
}

/// Between two boxes, which lie nearest to one another at a corner of one.
double distance_between(const Obstacle& a, const Obstacle& b) {
  double least = std::min(distance_to_box(a, b.center), distance_to_box(b, a.center));
  for (const Eigen::Vector3d& corner : corners(b)) {
    least = std::min(least, distance_to_box(a, corner));
  }
  for (const Eigen::Vector3d& corner : corners(a)) {
    least = std::min(least, distance_to_box(b, corner));
  }
  return least;
}

/// The middle and the size of what holds two intervals.
std::pair<double, double> hull(double low_a, double high_a, double low_b, double high_b) {
  const double low = std::min(low_a, low_b), high = std::max(high_a, high_b);
  return {(low + high) / 2, high - low};
}

void join_to(Obstacle& whole, const Obstacle& piece) {
  const auto outline = corners(piece);
  Eigen::Vector2d low = in_box(whole, outline[0]), high = low;
  for (const Eigen::Vector3d& corner : outline) {
    low = low.cwiseMin(in_box(whole, corner));
    high = high.cwiseMax(in_box(whole, corner));
  }
  const Eigen::Vector3d half = whole.extent / 2;
  const auto [along, length] = hull(-half.x(), half.x(), low.x(), high.x());
  const auto [across, width] = hull(-half.y(), half.y(), low.y(), high.y());
  const double up = piece.center.z() - whole.center.z(), half_up = piece.extent.z() / 2;
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
  if (std::abs(piece.height) > std::abs(whole.height)) whole.height = piece.height;
  whole.points += piece.points;
  whole.id = std::min(whole.id, piece.id);
}

/// Whether the box of both holds little more than the two, and not the ground in the corner between
/// a ditch and a pit beside its end.
bool fill_a_box(const Obstacle& a, const Obstacle& b) {
  constexpr double kMargin = 0.2;  // metres around each in all
  const auto area = [](const Obstacle& box, double margin) {
    return (box.extent.x() + margin) * (box.extent.y() + margin);
  };
  Obstacle both = a;
  join_to(both, b);
  return area(both, 0) <= area(a, kMargin) + area(b, kMargin);
}

bool is_piece(const Obstacle& whole, const Obstacle& piece) {
  if (whole.kind != piece.kind) return false;
  constexpr double kFarthest = 3;  // metres
  const double distance = distance_between(whole, piece);
  if (distance > kFarthest) return false;

  constexpr std::uint32_t kLarger = 3;
  const bool is_inside = distance_to_box(whole, piece.center) <= 0;
  if (is_inside && whole.points > kLarger * piece.points) return true;
  constexpr double kNear = 0.5, kSliver = 0.15;
  const bool is_sliver = piece.extent.y() <= kSliver;
  const bool is_hole = piece.kind == ObstacleKind::negative;
  if (distance <= kNear && (is_sliver || (is_hole && fill_a_box(whole, piece)))) return true;

  // Parts of a wall lie on one line, and no further apart than what is known of it is long: a post
  // and a board are two.
  constexpr double kThin = 0.12, kInLine = 0.99;
  const Eigen::Vector2d to = in_box(whole, piece.center);
  return whole.extent.y() <= kThin && distance <= whole.extent.x() &&
         std::abs(to.x()) >= kInLine * to.norm();
}

}  // namespace

double distance_to_box(const Obstacle& obstacle, const Eigen::Vector3d& place) {
  const Eigen::Vector2d half = obstacle.extent.head<2>() / 2;
  return (in_box(obstacle, place).cwiseAbs() - half).cwiseMax(0).norm();
}

Pieces::Pieces(std::size_t max_obstacles) : bonds_(max_obstacles), wholes_(max_obstacles) {}

/// Whether two are one thing, by what is seen now or was lately.
bool Pieces::renew(std::int64_t one, std::int64_t other, bool is_piece) {
  constexpr int kStrongest = 4;  // lists more that speak for it than against it
  const auto bond = std::ranges::find_if(bonds_, [&](const Bond& each) {
    return each.one == std::min(one, other) && each.other == std::max(one, other);
  });
  if (bond == bonds_.end()) {
    // Where there is no room the two are joined all the same, by what is seen.
    if (is_piece) bonds_.push_back({std::min(one, other), std::max(one, other), 1, true});
    return is_piece;
  }
  bond->is_asked = true;
  bond->strength = std::clamp(bond->strength + (is_piece ? 1 : -1), 0, kStrongest);
  return bond->strength > 0;
}

void Pieces::join(FixedVector<Obstacle>& obstacles) {
  std::sort(obstacles.begin(), obstacles.end(), [](const Obstacle& a, const Obstacle& b) {
    return a.points != b.points ? a.points > b.points : a.id < b.id;
  });
  std::size_t lasting = 0;
  for (Bond& bond : bonds_) {
    if (!bond.is_asked) --bond.strength;  // one of the two is gone
    bond.is_asked = false;
    if (bond.strength > 0) bonds_[lasting++] = bond;
  }
  bonds_.resize(lasting);
  wholes_.clear();
  for (const Obstacle& obstacle : obstacles) {
    std::size_t i = 0;
    while (i < wholes_.size() &&
           !(obstacles[i].kind == obstacle.kind &&
             renew(wholes_[i], obstacle.id, is_piece(obstacles[i], obstacle)))) {
      ++i;
    }
    if (i < wholes_.size()) {
      join_to(obstacles[i], obstacle);
    } else {
      obstacles[i] = obstacle;
      wholes_.push_back(obstacle.id);
    }
  }
  obstacles.resize(wholes_.size());
}

void keep_the_surer(FixedVector<Obstacle>& obstacles) {
  const auto is_outdone = [&](const Obstacle& one) {
    return std::ranges::any_of(obstacles, [&](const Obstacle& other) {
      if (other.kind == one.kind) return false;
      const bool is_hole = one.kind == ObstacleKind::negative;
      const Obstacle &rock = is_hole ? other : one, &hole = is_hole ? one : other;
      return distance_to_box(rock, hole.center) <= 0 &&
             (is_hole ? hole.confidence <= rock.confidence : rock.confidence < hole.confidence);
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
