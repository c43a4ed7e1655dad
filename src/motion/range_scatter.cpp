#include "scree/motion/range_scatter.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

void RangeScatter::add(std::uint8_t laser, const Eigen::Vector3f& seen, FixedVector<float>& scatter,
                       FixedVector<std::uint8_t>& is_isolated) {
  // The sensor turns 0.1 to 0.4 degrees from shot to shot; two returns of one shot are no
  // neighbours.
  constexpr float kLeastStep = 0.0008F, kMostStep = 0.011F;  // rad
  constexpr float kBeside = 0.0175F, kAsFar = 0.3F;          // rad, metres
  if (!scatter.push_back(kMost) || !is_isolated.push_back(1)) return;
  Latest& latest = lasers_[laser % kLasers];
  Shot shot;
  shot.range = seen.norm();
  shot.along = seen / shot.range;
  shot.index = scatter.size() - 1;
  for (const Shot& other : latest.shots) {
    const bool is_beside = (other.along - shot.along).squaredNorm() <= kBeside * kBeside;
    if (!is_beside || std::abs(other.range - shot.range) > kAsFar) continue;
    is_isolated[other.index] = is_isolated[shot.index] = 0;
  }
  const Shot& last = latest.back(1);
  const float step = (shot.along - last.along).norm();
  if (step < kLeastStep) return;
  if (step < kMostStep) {
    shot.step = step;
    if (last.step > 0) {
      const Shot& before = latest.back(2);
      const float between = (before.range * step + shot.range * last.step) / (step + last.step);
      const float off = std::abs(last.range - between);
      for (const std::size_t i : {before.index, last.index, shot.index}) {
        scatter[i] = std::min(scatter[i], off);
      }
    }
  }
  latest.shots[latest.count++ % Latest::kShots] = shot;
}

}  // namespace scree
