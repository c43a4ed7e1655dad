#pragma once

#include <Eigen/Core>
#include <span>

namespace scree {

/// Reorders them. Zero where there are none.
double median(std::span<double> values);

/// Weights in (0, 1] of residuals by the Cauchy function, whose width is that of most of them.
Eigen::VectorXd cauchy_weights(const Eigen::VectorXd& residuals);

inline constexpr int kRobustRounds = 15;  ///< of weighting anew

/// The factors x of columns * x = sums by least squares, in which what fits badly counts less.
Eigen::VectorXd robust_fit(const Eigen::MatrixXd& columns, const Eigen::VectorXd& sums);

/// The mean direction of vectors, each by its length.
Eigen::Vector3d robust_direction(const Eigen::Matrix3Xd& vectors);

/// The rotation that best lays the columns of `from` onto those of `to` (Wahba's problem by
/// singular values, Kabsch 1976).
Eigen::Matrix3d robust_rotation(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

}  // namespace scree
