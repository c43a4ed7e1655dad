#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <optional>

namespace scree {

/// What a measurement knows of a state: the sum of squares e^T information e + 2 gradient^T e of an
/// error e.
template <int kSize>
struct StateEvidence {
  Eigen::Matrix<double, kSize, kSize> information = Eigen::Matrix<double, kSize, kSize>::Zero();
  Eigen::Matrix<double, kSize, 1> gradient = Eigen::Matrix<double, kSize, 1>::Zero();
};
/// The error is that of the position in the map's frame (m), then the rotation vector in it (rad).
using PoseEvidence = StateEvidence<6>;
/// Then those of the velocity (m/s) and of the angular rate (rad/s).
using TwistEvidence = StateEvidence<12>;

/// How a point's distance along a direction changes with the error of a pose.
/// @param rotated the point from the pose's origin, metres; this and the direction in the map's
/// frame
inline Eigen::Matrix<double, 6, 1> pose_jacobian(const Eigen::Vector3d& rotated,
                                                 const Eigen::Vector3d& direction) {
  Eigen::Matrix<double, 6, 1> jacobian;
  jacobian << direction, rotated.cross(direction);
  return jacobian;
}

/// The update of an iterated extended Kalman filter by evidence about the first of its errors.
template <int kErrors>
class IteratedUpdate {
public:
  using Errors = Eigen::Matrix<double, kErrors, 1>;
  using Covariance = Eigen::Matrix<double, kErrors, kErrors>;

  void begin(Covariance& covariance) {
    covariance = 0.5 * (covariance + covariance.transpose()).eval();
    covariance.diagonal().array() += 1e-12;
    prior_ = covariance.inverse();
    applied_.setZero();
  }
  /// One round. @param evidence linearised at what was corrected so far
  /// @return what to correct now; nothing where the evidence is no numbers
  template <int kSize>
  std::optional<Errors> round(const StateEvidence<kSize>& evidence) {
    Errors gradient = prior_ * applied_;
    gradient.template head<kSize>() += evidence.gradient;
    const Errors correction = -information(evidence).llt().solve(gradient);
    if (!correction.allFinite()) return std::nullopt;
    applied_ += correction;
    return correction;
  }
  /// @param evidence of the last round
  template <int kSize>
  void end(const StateEvidence<kSize>& evidence, Covariance& covariance) const {
    covariance = information(evidence).inverse();
  }

private:
  template <int kSize>
  Covariance information(const StateEvidence<kSize>& evidence) const {
    Covariance information = prior_;
    information.template topLeftCorner<kSize, kSize>() += evidence.information;
    return information;
  }

  Covariance prior_ = Covariance::Zero();
  Errors applied_ = Errors::Zero();
};

}  // namespace scree
