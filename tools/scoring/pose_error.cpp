#include "scoring/pose_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/rotation.hpp"

namespace scree {
PoseError pose_error(const std::vector<PosePair>& poses) {
  PoseError error;
  if (poses.empty()) return error;
  const PosePair& first = poses.front();
  const double turn = yaw_of(first.truth.rotation) - yaw_of(first.reported.rotation);
  const Eigen::AngleAxisd laid(turn, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d before = first.truth.translation;
  for (const PosePair& pose : poses) {
    const Eigen::Vector3d moved = laid * (pose.reported.translation - first.reported.translation);
    error.last = (first.truth.translation + moved - pose.truth.translation).norm();
    error.most = std::max(error.most, error.last);
    error.way += (pose.truth.translation - before).norm();
    before = pose.truth.translation;
    error.yaw = std::remainder(yaw_of(pose.reported.rotation) + turn - yaw_of(pose.truth.rotation),
                               2 * std::numbers::pi);
    error.most_yaw = std::max(error.most_yaw, std::abs(error.yaw));
  }
  error.seconds = (static_cast<double>(poses.back().t_ns) - static_cast<double>(first.t_ns)) * 1e-9;
  return error;
}

}  // namespace scree
