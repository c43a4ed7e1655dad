#include "scoring/pose_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/rotation.hpp"

namespace scree {

Pose laid_onto(const Pose& pose, const Pose& other) {
  const double turn = yaw_of(other.rotation) - yaw_of(pose.rotation);
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
  return {other.translation - rotation * pose.translation, rotation};
}

PoseError pose_error(const std::vector<PosePair>& poses) {
  PoseError error;
  if (poses.empty()) return error;
  const PosePair& first = poses.front();
  const Pose laid = laid_onto(first.reported, first.truth);
  Eigen::Vector3d before = first.truth.translation;
  for (const PosePair& pose : poses) {
    error.last = (laid * pose.reported.translation - pose.truth.translation).norm();
    error.most = std::max(error.most, error.last);
    error.way += (pose.truth.translation - before).norm();
    before = pose.truth.translation;
    error.yaw =
        std::remainder(yaw_of(laid.rotation * pose.reported.rotation) - yaw_of(pose.truth.rotation),
                       2 * std::numbers::pi);
    error.most_yaw = std::max(error.most_yaw, std::abs(error.yaw));
  }
  error.seconds = (static_cast<double>(poses.back().t_ns) - static_cast<double>(first.t_ns)) * 1e-9;
  return error;
}

}  // namespace scree
