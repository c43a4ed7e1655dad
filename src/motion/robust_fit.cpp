#include "robust_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace scree {

double median(std::span<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::VectorXd cauchy_weights(const Eigen::VectorXd& residuals) {
  constexpr double kWidth = 1.5, kLeastWidth = 1e-6;
  std::vector<double> sizes(residuals.begin(), residuals.end());
  for (double& size : sizes) size = std::abs(size);
  const double width = std::max(kWidth * median(sizes), kLeastWidth);
  return (1 + (residuals / width).array().square()).inverse();
}

Eigen::VectorXd robust_fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& sums) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(sums.size()), factors;
  for (int round = 0; round < kRobustRounds; ++round) {
    const Eigen::MatrixXd weighted = columns.transpose() * weights.asDiagonal();
    factors = (weighted * columns).ldlt().solve(weighted * sums);
    weights = cauchy_weights(sums - columns * factors);
  }
  return factors;
}

Eigen::Matrix3d robust_rotation(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(from.cols());
  Eigen::Matrix3d rotation;
  for (int round = 0; round < kRobustRounds; ++round) {
    const Eigen::Matrix3d sum = to * weights.asDiagonal() * from.transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    signs.z() = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
    rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    weights = cauchy_weights((to - rotation * from).colwise().norm());
  }
  return rotation;
}

Eigen::Vector3d robust_direction(const Eigen::Matrix3Xd& vectors) {
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(vectors.cols());
  Eigen::Vector3d mean;
  for (int round = 0; round < kRobustRounds; ++round) {
    mean = (vectors * weights).normalized();
    weights = cauchy_weights((vectors.colwise().normalized().colwise() - mean).colwise().norm());
  }
  return mean;
}

}  // namespace scree
