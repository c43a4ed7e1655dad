#include "scree/motion/sweep_trajectory.hpp"

#include <algorithm>

namespace scree {

SweepTrajectory SweepTrajectory::of_sensor(const Pose& mount) const {
  const Eigen::Matrix3f rotation = mount.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = mount.translation.cast<float>();
  SweepTrajectory sensor = *this;
  for (Transform& each : sensor.transforms_) {
    each = {each.rotation * rotation, each.rotation * translation + each.translation};
  }
  return sensor;
}

SweepTrajectory::Transform SweepTrajectory::at(std::int64_t before_end_ns) const {
  const float step = static_cast<float>(before_end_ns) / static_cast<float>(step_ns_);
  if (!(step + 1 < static_cast<float>(transforms_.size()))) return transforms_.back();
  const auto index = static_cast<std::size_t>(std::max(step, 0.0F));
  const float share = step - static_cast<float>(index);
  const Transform& late = transforms_[index];
  const Transform& early = transforms_[index + 1];
  // Within 5 ms the turn is so small that the matrices may be mixed.
  return {late.rotation + share * (early.rotation - late.rotation),
          late.translation + share * (early.translation - late.translation)};
}

}  // namespace scree
