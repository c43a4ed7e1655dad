#include "scree/motion/range_scatter.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

/// A shot and those that end beside it are not isolated.
void RangeScatter::mark_neighbours(const RecentShots& recent, const Shot& shot,
                                   FixedVector<std::uint8_t>& is_isolated) {
  constexpr float kMaxAngle = 0.0175F, kMaxApart = 0.3F;  // rad: a degree; metres
  for (const Shot& other : recent.shots) {
    const bool is_beside =
        (other.direction - shot.direction).squaredNorm() <= kMaxAngle * kMaxAngle;
    if (!is_beside || std::abs(other.range - shot.range) > kMaxApart) continue;
    is_isolated[other.index] = is_isolated[shot.index] = 0;
  }
}

void RangeScatter::add(std::uint8_t laser, const Eigen::Vector3f& point,
                       FixedVector<float>& scatter, FixedVector<std::uint8_t>& is_isolated) {
  // The sensor turns 0.1 to 0.4 degrees from shot to shot (VLP-16 manual 63-9243 Rev. D: 55.296 us
  // at 300 to 1200 rpm); two returns of one shot are no neighbours.
  constexpr float kMinStep = 0.0008F, kMaxStep = 0.011F;  // rad
  if (!scatter.push_back(kMaxScatter) || !is_isolated.push_back(1)) return;
  RecentShots& recent = lasers_[laser % kLasers];
  Shot shot;
  shot.range = point.norm();
  shot.direction = point / shot.range;
  shot.index = scatter.size() - 1;
  mark_neighbours(recent, shot, is_isolated);
  const Shot& last = recent.back(1);
  const float step = (shot.direction - last.direction).norm();
  if (step < kMinStep) return;
  if (step < kMaxStep) {
    shot.step = step;
    if (last.step > 0) {
      const Shot& before = recent.back(2);
      const float between = (before.range * step + shot.range * last.step) / (step + last.step);
      const float off = std::abs(last.range - between);
      for (const std::size_t i : {before.index, last.index, shot.index}) {
        scatter[i] = std::min(scatter[i], off);
      }
    }
  }
  recent.shots[recent.count++ % RecentShots::kShots] = shot;
}

}  // namespace scree
