#include "scree/motion/range_scatter.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

void RangeScatter::add(std::uint8_t laser, const Eigen::Vector3f& seen,
                       FixedVector<float>& scatter) {
  // The sensor turns 0.1 to 0.4 degrees from shot to shot; two returns of one shot are no
  // neighbours.
  constexpr float kLeastStep = 0.0008F, kMostStep = 0.011F;  // rad
  if (!scatter.push_back(kMost)) return;
  auto& [last, before] = lasers_[laser % kLasers];
  Shot shot;
  shot.range = seen.norm();
  shot.along = seen / shot.range;
  shot.index = scatter.size() - 1;
  const float step = (shot.along - last.along).norm();
  if (step < kLeastStep) return;
  if (step < kMostStep) {
    shot.step = step;
    if (last.step > 0) {
      const float between = (before.range * step + shot.range * last.step) / (step + last.step);
      const float off = std::abs(last.range - between);
      for (const std::size_t i : {before.index, last.index, shot.index}) {
        scatter[i] = std::min(scatter[i], off);
      }
    }
  }
  before = last;
  last = shot;
}

}  // namespace scree
