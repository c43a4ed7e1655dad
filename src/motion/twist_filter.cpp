#include "scree/motion/twist_filter.hpp"

#include <cmath>

#include "scree/core/rotation.hpp"

namespace scree {
namespace {

// Standard deviations.
constexpr double kFirstSpeed = 1;   // m/s: some drives begin on the way
constexpr double kFirstRate = 0.3;  // rad/s
constexpr double kSpeedWalk = 1.0;  // m/s in a square root of a second: it swings on its mast
constexpr double kRateWalk = 1.2;   // rad/s in a square root of a second, on rough ground

}  // namespace

TwistFilter::TwistFilter() {
  covariance_.diagonal().segment<3>(6).setConstant(kFirstSpeed * kFirstSpeed);
  covariance_.diagonal().segment<3>(9).setConstant(kFirstRate * kFirstRate);
}

void TwistFilter::predict(double seconds) {
  pose_.translation += velocity_ * seconds;
  const Eigen::Quaterniond turn = exponential(rate_ * seconds);
  pose_.rotation = (turn * pose_.rotation).normalized();
  velocity_ = turn * velocity_;
  predicted_velocity_ = velocity_;
  predicted_rate_ = rate_;

  Covariance transition = Covariance::Identity();
  transition.block<6, 6>(0, 6).diagonal().setConstant(seconds);
  covariance_ = transition * covariance_ * transition.transpose();
  const auto add_noise = [&](int at, double walk) {
    const double q = walk * walk * seconds;
    for (int i = at; i < at + 3; ++i) {
      covariance_(i, i) += q * seconds * seconds / 3;
      covariance_(i, i + 6) += q * seconds / 2;
      covariance_(i + 6, i) += q * seconds / 2;
      covariance_(i + 6, i + 6) += q;
    }
  };
  add_noise(0, kSpeedWalk);
  add_noise(3, kRateWalk);
}

void TwistFilter::begin_update() {
  update_.begin(covariance_);
}

double TwistFilter::update(const TwistEvidence& evidence) {
  const auto correction = update_.round(evidence);
  if (!correction) return 0;
  apply(*correction);
  return correction->head<6>().norm();
}

void TwistFilter::end_update(const TwistEvidence& evidence) {
  update_.end(evidence, covariance_);
}

void TwistFilter::apply(const Errors& error) {
  pose_.translation += error.head<3>();
  pose_.rotation = (exponential(error.segment<3>(3)) * pose_.rotation).normalized();
  velocity_ += error.segment<3>(6);
  rate_ += error.tail<3>();
}

Eigen::Vector3d TwistFilter::place(const Eigen::Vector3d& point, double before_s) const {
  const Eigen::Vector3d rotated = pose_.rotation * point;
  const Eigen::Vector3d velocity(0, 0, velocity_.z() - predicted_velocity_.z());
  const Eigen::Vector3d rate(rate_.x() - predicted_rate_.x(), rate_.y() - predicted_rate_.y(), 0);
  return pose_.translation + rotated - before_s * (velocity + rate.cross(rotated));
}

TwistFilter::Errors TwistFilter::jacobian(const Eigen::Vector3d& point, double before_s,
                                          const Eigen::Vector3d& direction) const {
  const Eigen::Matrix<double, 6, 1> of_pose = pose_jacobian(pose_.rotation * point, direction);
  Errors jacobian;
  jacobian << of_pose, 0, 0, -before_s * of_pose.segment<3>(2), 0;
  return jacobian;
}

void TwistFilter::write(SweepTrajectory& trajectory, double seconds) const {
  constexpr int kSteps = 20;
  const Eigen::Vector3d velocity = pose_.rotation.conjugate() * velocity_;
  const Eigen::Vector3d rate = pose_.rotation.conjugate() * rate_;
  trajectory.start(static_cast<std::int64_t>(seconds * 1e9 / kSteps));
  for (int i = 0; i <= kSteps; ++i) {
    const double before = seconds * i / kSteps;
    trajectory.push_back({exponential(-rate * before).toRotationMatrix().cast<float>(),
                          (-velocity * before).cast<float>()});
  }
}

double TwistFilter::speed_deviation(const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d in_frame = pose_.rotation * direction;
  return std::sqrt(in_frame.dot(covariance_.block<3, 3>(6, 6) * in_frame));
}

}  // namespace scree
