#include "scoring/pose_error.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

double yaw_of(const Pose& pose) {
  const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

}  // namespace

PoseError pose_error(const std::vector<PosePair>& poses) {
  PoseError error;
  if (poses.empty()) return error;
  const PosePair& first = poses.front();
  const double turn = yaw_of(first.truth) - yaw_of(first.reported);
  const Eigen::AngleAxisd laid(turn, Eigen::Vector3d::UnitZ());
  Eigen::Vector3d before = first.truth.translation;
  for (const PosePair& pose : poses) {
    const Eigen::Vector3d moved = laid * (pose.reported.translation - first.reported.translation);
    error.last = (first.truth.translation + moved - pose.truth.translation).norm();
    error.most = std::max(error.most, error.last);
    error.way += (pose.truth.translation - before).norm();
    before = pose.truth.translation;
    error.yaw =
        std::remainder(yaw_of(pose.reported) + turn - yaw_of(pose.truth), 2 * std::numbers::pi);
    error.most_yaw = std::max(error.most_yaw, std::abs(error.yaw));
  }
  error.seconds = (static_cast<double>(poses.back().t_ns) - static_cast<double>(first.t_ns)) * 1e-9;
  return error;
}

}  // namespace scree
