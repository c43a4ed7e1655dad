#include "scree/detect/viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "scree/detect/quantile.hpp"

namespace scree {
namespace {

/// How high a place lies above the ground near it, metres; 0 without points near it.
float height_above_ground(const Eigen::Vector3f& place, PointView cloud) {
  constexpr float kNear = 3;  // metres
  constexpr double kGround = 0.2;
  std::vector<float> heights;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::hypot(cloud.x[i] - place.x(), cloud.y[i] - place.y()) < kNear &&
        std::isfinite(cloud.z[i])) {
      heights.push_back(cloud.z[i]);
    }
  }
  return heights.empty() ? 0 : place.z() - quantile(heights, kGround);
}

/// Share of the points that lie well behind another one in nearly the same direction.
float hidden_share(const Eigen::Vector3f& viewpoint, PointView cloud) {
  constexpr std::size_t kColumns = 360, kRows = 180;  // directions, a degree apart
  constexpr float kPi = std::numbers::pi_v<float>;
  constexpr float kBehind = 0.5F, kBehindShare = 1.1F;  // metres, share of the range
  std::vector<float> nearest(kColumns * kRows, std::numeric_limits<float>::infinity());
  std::vector<std::pair<std::size_t, float>> seen;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f to = Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]) - viewpoint;
    const float range = to.norm();
    if (!std::isfinite(range) || range == 0) continue;
    const float azimuth = std::atan2(to.y(), to.x()) + kPi, elevation = std::acos(to.z() / range);
    const auto column = static_cast<std::size_t>(azimuth / (2 * kPi) * kColumns) % kColumns;
    const auto row = std::min(static_cast<std::size_t>(elevation / kPi * kRows), kRows - 1);
    const std::size_t direction = row * kColumns + column;
    nearest[direction] = std::min(nearest[direction], range);
    seen.emplace_back(direction, range);
  }
  const auto hidden = std::ranges::count_if(seen, [&](const auto& each) {
    return each.second > kBehindShare * nearest[each.first] + kBehind;
  });
  return seen.empty() ? 1 : static_cast<float>(hidden) / static_cast<float>(seen.size());
}

}  // namespace

bool could_be_seen_from(const Eigen::Vector3f& viewpoint, PointView cloud) {
  constexpr float kLeastHeight = 0.3F;  // metres
  constexpr float kMostHidden = 0.25F;  // in a wood a tenth is
  return height_above_ground(viewpoint, cloud) >= kLeastHeight &&
         hidden_share(viewpoint, cloud) <= kMostHidden;
}

}  // namespace scree
