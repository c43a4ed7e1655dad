#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <optional>

namespace scree {

/// What a measurement knows of a pose: the sum of squares e^T information e + 2 gradient^T e of an
/// error e. That is the position in the map's frame (m), then the rotation vector in it (rad).
struct PoseEvidence {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
};

/// The update of an iterated extended Kalman filter by evidence about the first six of its errors.
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
  std::optional<Errors> round(const PoseEvidence& evidence) {
    Errors gradient = prior_ * applied_;
    gradient.template head<6>() += evidence.gradient;
    const Errors correction = -information(evidence).llt().solve(gradient);
    if (!correction.allFinite()) return std::nullopt;
    applied_ += correction;
    return correction;
  }
  /// @param evidence of the last round
  void end(const PoseEvidence& evidence, Covariance& covariance) const {
    covariance = information(evidence).inverse();
  }

private:
  Covariance information(const PoseEvidence& evidence) const {
    Covariance information = prior_;
    information.template topLeftCorner<6, 6>() += evidence.information;
    return information;
  }

  Covariance prior_;
  Errors applied_;
};

}  // namespace scree
