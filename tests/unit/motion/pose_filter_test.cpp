#include "scree/motion/pose_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "allocation_counter.hpp"
#include "motion_steps.hpp"
#include "scree/core/rotation.hpp"

namespace scree {
namespace {

using test::ahead;
using test::step_of;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Rows of H measure errors with independent deviations; `off` is what they read.
struct Measurement {
  Matrix rows;
  Vector deviations, off;

  PoseEvidence evidence() const {
    const Matrix weights = deviations.cwiseProduct(deviations).cwiseInverse().asDiagonal();
    PoseEvidence evidence;
    evidence.information = rows.transpose() * weights * rows;
    evidence.gradient = rows.transpose() * weights * off;
    return evidence;
  }
};

void apply(PoseFilter& filter, const PoseEvidence& evidence) {
  filter.begin_update();
  filter.update(evidence);
  filter.end_update(evidence);
}

Measurement random_measurement(std::mt19937& random, int rows) {
  std::normal_distribution<double> normal;
  Measurement measurement{Matrix(rows, 6), Vector(rows), Vector(rows)};
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < 6; ++k) measurement.rows(i, k) = normal(random);
    measurement.deviations[i] = 0.01 + 0.02 * std::abs(normal(random));
    measurement.off[i] = 0.003 * normal(random);
  }
  return measurement;
}

/// Puts the pose elsewhere by evidence as firm as can be.
PoseFilter displaced(PoseFilter filter, int direction, double by) {
  PoseEvidence evidence;
  constexpr double kFirm = 1e14;
  evidence.information = kFirm * Eigen::Matrix<double, 6, 6>::Identity();
  evidence.gradient[direction] = -kFirm * by;
  filter.begin_update();
  filter.update(evidence);
  return filter;
}

Eigen::Matrix<double, 6, 1> difference(const Pose& a, const Pose& b) {
  Eigen::Matrix<double, 6, 1> error;
  error << b.translation - a.translation, logarithm(b.rotation * a.rotation.conjugate());
  return error;
}

TEST(PoseFilter, BeginsAtTheOriginWithItsOwnYaw) {
  PoseFilter filter;
  const auto attitude = from_roll_pitch_yaw(0.1, -0.2, 2.3);
  filter.predict(step_of(attitude, attitude, 5));
  EXPECT_EQ(filter.pose().translation, Eigen::Vector3d::Zero());
  EXPECT_LT(filter.pose().rotation.angularDistance(from_roll_pitch_yaw(0.1, -0.2, 0)), 1e-9);
  EXPECT_EQ(filter.position_deviation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(filter.rotation_deviation().z(), 0);
  EXPECT_GT(filter.rotation_deviation().x(), 0);
}

// The covariance's way through a step, against differences of the prediction itself.
TEST(PoseFilter, PredictsErrorsAsItPredictsPoses) {
  std::mt19937 random(4);
  PoseFilter first;
  const auto a = from_roll_pitch_yaw(0.1, 0.2, -0.3), b = from_roll_pitch_yaw(0.15, 0.1, 0.1);
  first.predict(step_of(a, a, 0));
  for (int i = 0; i < 10; ++i) first.predict(step_of(a, a, 0.3));
  PoseFilter second = first;
  // Another covariance at the same pose: what is added by the step must be the same in both.
  Measurement measurement = random_measurement(random, 4);
  measurement.off.setZero();
  apply(second, measurement.evidence());

  const MotionStep step = step_of(a, b, 0.7, 2);
  PoseFilter predicted = first, other = second;
  predicted.predict(step);
  other.predict(step);
  const Eigen::Vector3d moved = predicted.pose().translation - first.pose().translation;
  PoseFilter::Covariance transition = PoseFilter::Covariance::Identity();
  transition.block<3, 1>(0, 6) = moved;
  transition(5, 7) = step.seconds();
  for (int k = 0; k < 6; ++k) {
    constexpr double kSmall = 1e-5;
    PoseFilter plus = displaced(first, k, kSmall), minus = displaced(first, k, -kSmall);
    const auto before = difference(minus.pose(), plus.pose());
    EXPECT_NEAR(before[k], 2 * kSmall, 1e-9);
    // The evidence has moved what hangs together with the pose, too.
    const double scale = plus.scale_error() - minus.scale_error();
    const double drift = plus.yaw_drift() - minus.yaw_drift();
    plus.predict(step);
    minus.predict(step);
    Eigen::Matrix<double, 6, 1> after = difference(minus.pose(), plus.pose());
    after -= transition.block<6, 1>(0, 6) * scale + transition.block<6, 1>(0, 7) * drift;
    transition.block<6, 1>(0, k) = after / (2 * kSmall);
  }

  const PoseFilter::Covariance added =
      predicted.covariance() - transition * first.covariance() * transition.transpose();
  const PoseFilter::Covariance added_too =
      other.covariance() - transition * second.covariance() * transition.transpose();
  EXPECT_GT((first.covariance() - second.covariance()).norm(), 1e-4);
  EXPECT_LT((added - added_too).cwiseAbs().maxCoeff(), 3e-7);
  const Eigen::SelfAdjointEigenSolver<PoseFilter::Covariance> solver(added);
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-6);
}

TEST(PoseFilter, UpdatesAsAPlainKalmanFilterDoes) {
  std::mt19937 random(5);
  PoseFilter filter;
  filter.predict(ahead(0));
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < 5; ++i) filter.predict(ahead(0.2));
    const Measurement measurement = random_measurement(random, 1 + round % 7);
    const Matrix before = filter.covariance();
    const Pose pose = filter.pose();
    const double scale = filter.scale_error(), drift = filter.yaw_drift();

    Matrix rows = Matrix::Zero(measurement.rows.rows(), 8);
    rows.leftCols(6) = measurement.rows;
    const Matrix noise = measurement.deviations.cwiseProduct(measurement.deviations).asDiagonal();
    const Matrix gain =
        before * rows.transpose() * (rows * before * rows.transpose() + noise).inverse();
    const Vector expected = -gain * measurement.off;
    const Matrix after = (Matrix::Identity(8, 8) - gain * rows) * before;

    apply(filter, measurement.evidence());
    EXPECT_LT((filter.covariance() - after).cwiseAbs().maxCoeff(), 1e-7) << round;
    EXPECT_LT((difference(pose, filter.pose()) - expected.head(6)).norm(), 1e-5) << round;
    EXPECT_NEAR(filter.scale_error() - scale, expected[6], 1e-6) << round;
    EXPECT_NEAR(filter.yaw_drift() - drift, expected[7], 1e-7) << round;
  }
}

// The pose moves between the rounds, and evidence is then read from the new place.
TEST(PoseFilter, MoreRoundsOfTheSameMeasurementChangeNothing) {
  std::mt19937 random(6);
  PoseFilter filter;
  filter.predict(ahead(0));
  for (int i = 0; i < 10; ++i) filter.predict(ahead(0.2));
  Measurement measurement = random_measurement(random, 3);
  PoseFilter once = filter;
  apply(once, measurement.evidence());

  const Pose start = filter.pose();
  filter.begin_update();
  const Vector off = measurement.off;
  double correction = 1;
  for (int round = 0; round < 4; ++round) {
    measurement.off = off + measurement.rows * difference(start, filter.pose());
    correction = filter.update(measurement.evidence());
  }
  filter.end_update(measurement.evidence());
  EXPECT_LT(correction, 1e-6);
  EXPECT_LT(difference(once.pose(), filter.pose()).norm(), 1e-5);
  EXPECT_TRUE(filter.covariance().isApprox(once.covariance(), 1e-6));
}

TEST(PoseFilter, EvidenceLeavesTheDirectionsThatItDoesNotBind) {
  PoseFilter filter;
  filter.predict(ahead(0));
  for (int i = 0; i < 30; ++i) filter.predict(ahead(0.2));
  const Eigen::Vector3d before = filter.position_deviation();
  Measurement height{Matrix::Zero(1, 6), Vector::Constant(1, 0.001), Vector::Constant(1, -0.05)};
  height.rows(0, 2) = 1;
  apply(filter, height.evidence());
  EXPECT_NEAR(filter.pose().translation.z(), 0.05, 0.001);
  EXPECT_LT(filter.position_deviation().z(), 0.0011);
  EXPECT_NEAR(filter.pose().translation.x(), 6, 1e-9);
  EXPECT_NEAR(filter.pose().translation.y(), 0, 1e-9);
  EXPECT_NEAR(filter.position_deviation().x(), before.x(), 1e-6);
  EXPECT_NEAR(filter.position_deviation().y(), before.y(), 1e-6);
}

TEST(PoseFilter, LearnsTheWheelsScaleAndTheDriftOfTheYaw) {
  constexpr double kDrift = 0.002, kScale = 1.012;  // rad/s, and what the wheel counts a metre
  PoseFilter filter;
  filter.predict(ahead(0));
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  for (int i = 1; i <= 600; ++i) {
    // Straight on in truth, at 1 m/s, while the IMU's yaw turns.
    const Eigen::Quaterniond next = exponential({0, 0, kDrift * 0.1 * i});
    filter.predict(step_of(attitude, next, 0.1 * kScale));
    attitude = next;
    Measurement truth{Matrix::Identity(6, 6), Vector::Constant(6, 0.01), Vector(6)};
    truth.off = difference({{0.1 * i, 0, 0}, Eigen::Quaterniond::Identity()}, filter.pose());
    apply(filter, truth.evidence());
  }
  EXPECT_NEAR(filter.scale_error(), 1 / kScale - 1, 0.002);
  EXPECT_NEAR(filter.yaw_drift(), -kDrift, 0.0003);
}

TEST(PoseFilter, TheTiltThatWasLearntFadesWhereNothingKeepsIt) {
  PoseFilter filter;
  filter.predict(ahead(0));
  Measurement tilt{Matrix::Zero(2, 6), Vector::Constant(2, 1e-4), Vector(2)};
  tilt.rows(0, 3) = tilt.rows(1, 4) = 1;
  tilt.off << -0.01, 0.006;
  apply(filter, tilt.evidence());
  const auto leaning = [&filter] {
    const Eigen::Vector3d up = filter.pose().rotation * Eigen::Vector3d::UnitZ();
    return std::hypot(up.x(), up.y());
  };
  double before = leaning();
  EXPECT_NEAR(before, std::hypot(0.01, 0.006), 1e-4);
  const double tilt_before = filter.rotation_deviation().x();
  for (int minute = 0; minute < 5; ++minute) {
    for (int i = 0; i < 600; ++i) filter.predict(ahead(0.1));
    EXPECT_LT(leaning(), 0.5 * before) << minute;
    before = leaning();
  }
  EXPECT_GT(filter.rotation_deviation().x(), tilt_before);
  EXPECT_LT(filter.rotation_deviation().x(), 0.05) << "roll and pitch are known by the IMU";
}

TEST(PoseFilter, TheCovarianceStaysOneWhateverComes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  PoseFilter filter;
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Quaterniond next = attitude * exponential({0, 0, 0.1 * uniform(random)});
    MotionStep step = step_of(attitude, next, 0.2 * uniform(random), i % 97 == 0 ? 12 : 0.1);
    step.knows_attitude = i / 50 % 3 != 1;
    step.knows_distance = i / 70 % 3 != 1;
    filter.predict(step);
    attitude = next;
    if (i % 3 == 0) {
      Measurement measurement = random_measurement(random, 1 + i % 5);
      measurement.off *= 0.1;
      apply(filter, measurement.evidence());
    }
    const PoseFilter::Covariance& covariance = filter.covariance();
    ASSERT_TRUE(covariance.allFinite()) << i;
    ASSERT_LT((covariance - covariance.transpose()).cwiseAbs().maxCoeff(),
              1e-9 * covariance.norm() + 1e-12)
        << i;
    const Eigen::SelfAdjointEigenSolver<PoseFilter::Covariance> solver(covariance);
    ASSERT_GT(solver.eigenvalues().minCoeff(), -1e-10 * covariance.norm()) << i;
    ASSERT_NEAR(filter.pose().rotation.norm(), 1, 1e-9);
  }
}

TEST(PoseFilter, AllocatesNothing) {
  std::mt19937 random(8);
  const PoseEvidence evidence = random_measurement(random, 3).evidence();
  PoseFilter filter;
  const std::size_t before = test::allocations();
  for (int i = 0; i < 100; ++i) {
    MotionStep step = ahead(0.1);
    step.knows_attitude = i / 10 % 2 == 0;
    filter.predict(step);
    apply(filter, evidence);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
