#include "scree/core/rotation.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <unsupported/Eigen/MatrixFunctions>

#include "scree/core/pose.hpp"

namespace scree {
namespace {

TEST(Rotation, ExponentialIsThatOfTheCrossProductsMatrix) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d v = Eigen::Vector3d(normal(random), normal(random), normal(random));
    Eigen::Matrix3d cross;
    cross << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    EXPECT_TRUE(exponential(v).toRotationMatrix().isApprox(cross.exp(), 1e-9));
  }
}

TEST(Pose, InverseGoesBackFromBothSides) {
  const Pose pose{{1, -2, 3}, from_roll_pitch_yaw(0.3, -0.5, 2)};
  for (const Pose& there_and_back : {pose * pose.inverse(), pose.inverse() * pose}) {
    EXPECT_LT(there_and_back.translation.norm(), 1e-12);
    EXPECT_LT(logarithm(there_and_back.rotation).norm(), 1e-12);
  }
}

TEST(Rotation, LogarithmUndoesExponentialBothWaysRoundTheSphere) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 500; ++i) {
    Eigen::Vector3d v(normal(random), normal(random), normal(random));
    v *= std::pow(10, -(i % 14)) / std::max(1.0, v.norm() / 3.1);
    const Eigen::Quaterniond rotation = exponential(v);
    EXPECT_LT((logarithm(rotation) - v).norm(), 1e-9 * (1 + v.norm())) << v.transpose();
    const Eigen::Quaterniond same(-rotation.coeffs());
    EXPECT_LT((logarithm(same) - v).norm(), 1e-9 * (1 + v.norm())) << v.transpose();
  }
  EXPECT_EQ(logarithm(Eigen::Quaterniond::Identity()), Eigen::Vector3d::Zero());
  EXPECT_EQ(exponential(Eigen::Vector3d::Zero()).w(), 1);
}

TEST(Rotation, YawIsTheHeadingOfTheXAxis) {
  for (double yaw = -3.1; yaw < 3.1; yaw += 0.3) {
    EXPECT_NEAR(yaw_of(from_roll_pitch_yaw(0.7, -0.4, yaw)), yaw, 1e-12);
  }
}

}  // namespace
}  // namespace scree
