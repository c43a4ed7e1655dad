#include "scree/terrain/registration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "allocation_counter.hpp"
#include "terrain/rough_ground.hpp"

namespace scree {
namespace {

class RegistrationTest : public testing::Test {
protected:
  SurfelMap map_{0.3F};
  Registration registration_{1 << 15};
  DeskewedSweep sweep_{1 << 15};
  PoseFilter filter_;

  void learn(const test::RoughGround& ground) {
    for (double x = -9; x < 9; x += 0.05) {
      for (double y = -9; y < 9; y += 0.05) {
        map_.add(Eigen::Vector3d(x, y, ground.height(x, y)).cast<float>());
      }
    }
  }
  /// The filter expects a robot at the origin; a sweep shows it elsewhere.
  Registration::Outcome align(const test::RoughGround& ground, const Pose& truth) {
    test::look(ground, truth, 6, 0.11, sweep_);
    return registration_.align(sweep_, map_, filter_);
  }
  /// Stands at the origin, and does not know it well in any direction.
  void be_unsure() {
    MotionStep step;
    step.knows_attitude = step.knows_distance = true;
    filter_.predict(step);
    step.end_ns = 2'000'000'000;
    step.knows_attitude = step.knows_distance = false;
    step.distance = 500;  // there and back
    filter_.predict(step);
  }
  double yaw_error(const Pose& truth) const {
    return std::abs(yaw_of(filter_.pose().rotation) - yaw_of(truth.rotation));
  }
};

TEST_F(RegistrationTest, FindsAKnownOffsetOnRoughGround) {
  const test::RoughGround rough;
  learn(rough);
  be_unsure();
  const PoseFilter unsure = filter_;
  const Pose truths[] = {
      {{0.08, -0.05, 0.03}, from_roll_pitch_yaw(0.01, -0.008, 0.03)},
      {{-0.06, 0.09, -0.04}, from_roll_pitch_yaw(-0.012, 0.01, -0.025)},
      {{0.02, 0.02, 0}, from_roll_pitch_yaw(0, 0, 0.05)},
  };
  for (const Pose& truth : truths) {
    filter_ = unsure;
    const Registration::Outcome outcome = align(rough, truth);
    EXPECT_GT(outcome.key_points, 200);
    EXPECT_GE(outcome.rounds, 2);
    EXPECT_LE(outcome.rounds, 5);
    EXPECT_LT(outcome.residual, 0.03);
    EXPECT_NEAR(outcome.correction, filter_.pose().translation.norm(), 1e-9);
    EXPECT_LT((filter_.pose().translation - truth.translation).norm(), 0.012);
    EXPECT_LT(filter_.pose().rotation.angularDistance(truth.rotation), radians(0.2));
    EXPECT_LT(filter_.position_deviation().maxCoeff(),
              0.5 * unsure.position_deviation().minCoeff());
    EXPECT_LT(filter_.rotation_deviation().maxCoeff(),
              0.5 * unsure.rotation_deviation().minCoeff());
  }
}

// Ground 0.12 m from where it was: to a pose that is known other things, to one that is not the
// ground.
TEST_F(RegistrationTest, TheThresholdFollowsHowWellThePoseIsKnown) {
  const test::RoughGround flat{.roughness = 0, .level = 0.075};
  learn(flat);
  const Pose truth{{0, 0, -0.12}, Eigen::Quaterniond::Identity()};
  MotionStep step;
  step.knows_attitude = step.knows_distance = true;
  filter_.predict(step);
  EXPECT_EQ(align(flat, truth).key_points, 0);
  EXPECT_EQ(filter_.pose().translation.z(), 0);
  be_unsure();
  EXPECT_GT(align(flat, truth).key_points, 200);
  EXPECT_NEAR(filter_.pose().translation.z(), -0.12, 0.003);
}

TEST_F(RegistrationTest, WhileTheImuIsSilentTheSweepBindsMore) {
  const test::RoughGround rough;
  learn(rough);
  be_unsure();
  PoseFilter silent = filter_;
  MotionStep step;
  step.begin_ns = 2'000'000'000;
  step.end_ns = 2'000'100'000;
  step.knows_attitude = step.knows_distance = true;
  filter_.predict(step);
  align(rough, Pose());
  std::swap(silent, filter_);
  align(rough, Pose());
  EXPECT_LT(filter_.position_deviation().z(), 0.7 * silent.position_deviation().z());
}

// A level plane says nothing of x, y and yaw: they stay as predicted, and as unsure.
TEST_F(RegistrationTest, FlatGroundBindsHeightRollAndPitchOnly) {
  const test::RoughGround flat{.roughness = 0, .level = 0.075};
  learn(flat);
  be_unsure();
  const PoseFilter before = filter_;
  const Pose truth{{0.08, -0.05, 0.04}, from_roll_pitch_yaw(0.012, -0.009, 0.03)};
  const Registration::Outcome outcome = align(flat, truth);
  EXPECT_GT(outcome.key_points, 200);
  const Pose& pose = filter_.pose();
  EXPECT_NEAR(pose.translation.x(), 0, 0.003);
  EXPECT_NEAR(pose.translation.y(), 0, 0.003);
  EXPECT_NEAR(yaw_of(pose.rotation), 0, radians(0.05));
  EXPECT_NEAR(pose.translation.z(), 0.04, 0.003);
  const Eigen::Vector3d up = pose.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d true_up = truth.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  EXPECT_LT((up - true_up).norm(), 0.001);

  const Eigen::Vector3d position =
      filter_.position_deviation().cwiseQuotient(before.position_deviation());
  const Eigen::Vector3d rotation =
      filter_.rotation_deviation().cwiseQuotient(before.rotation_deviation());
  EXPECT_GT(position.x(), 0.95);
  EXPECT_GT(position.y(), 0.95);
  EXPECT_GT(rotation.z(), 0.95);
  EXPECT_LT(position.z(), 0.2);
  EXPECT_LT(rotation.x(), 0.2);
  EXPECT_LT(rotation.y(), 0.2);
}

// A thirtieth of the points are on its flanks, and they alone bind x: taken evenly they would bind
// it four times less.
TEST_F(RegistrationTest, KeyPointsAreChosenByTheirNormals) {
  const auto ridge = [](double x, double y) {
    return std::abs(y) < 1 ? std::max(0.6 - 0.5 * std::abs(x - 3), 0.0) : 0.0;
  };
  for (double x = -6; x < 6; x += 0.05) {
    for (double y = -6; y < 6; y += 0.05) {
      map_.add(Eigen::Vector3d(x, y, ridge(x, y)).cast<float>());
    }
  }
  be_unsure();
  for (double x = -6; x < 6; x += 0.08) {
    for (double y = -6; y < 6; y += 0.08) {
      const Eigen::Vector3f seen = Eigen::Vector3d(x - 0.05, y, ridge(x, y)).cast<float>();
      sweep_.points.push_back(seen.x(), seen.y(), seen.z(), 20);
      sweep_.origins.push_back(Eigen::Vector3f(0, 0, 1));
      sweep_.time_ns.push_back(0);
      sweep_.scatter.push_back(0);
      sweep_.is_isolated.push_back(0);
      sweep_.is_moving.push_back(0);
      sweep_.is_suspect.push_back(0);
    }
  }
  registration_.align(sweep_, map_, filter_);
  EXPECT_NEAR(filter_.pose().translation.x(), 0.05, 0.005);
  EXPECT_LT(filter_.position_deviation().x(), 0.012);
}

// Where floats are coarse and the numbers of cells are large.
TEST_F(RegistrationTest, WorksManyKilometresFromTheOrigin) {
  const test::RoughGround rough;
  constexpr double kFar = 12'000.3;
  for (double x = -9; x < 9; x += 0.05) {
    for (double y = -9; y < 9; y += 0.05) {
      map_.add(Eigen::Vector3d(kFar + x, y, rough.height(x, y)).cast<float>());
    }
  }
  MotionStep step;
  step.knows_attitude = step.knows_distance = true;
  filter_.predict(step);
  step.end_ns = 2'000'000'000;
  step.displacement.x() = kFar;
  step.distance = 500;
  filter_.predict(step);
  const Pose truth{{0.08, -0.05, 0.03}, from_roll_pitch_yaw(0.005, -0.004, 0)};
  const Registration::Outcome outcome = align(rough, truth);
  EXPECT_GT(outcome.key_points, 200);
  const Eigen::Vector3d found = filter_.pose().translation - Eigen::Vector3d(kFar, 0, 0);
  EXPECT_LT((found - truth.translation).norm(), 0.015);
  EXPECT_LT(filter_.pose().rotation.angularDistance(truth.rotation), radians(0.3));
}

/// A ditch along x binds y and yaw, and still says nothing of x.
TEST_F(RegistrationTest, ADitchLeavesTheDirectionAlongIt) {
  const auto ditch = [](double y) { return 0.25 * std::sin(1.5 * y); };
  for (double x = -9; x < 9; x += 0.05) {
    for (double y = -9; y < 9; y += 0.05) map_.add(Eigen::Vector3d(x, y, ditch(y)).cast<float>());
  }
  be_unsure();
  const Eigen::Vector3d before = filter_.position_deviation();
  for (double x = -6; x < 6; x += 0.11) {
    for (double y = -6; y < 6; y += 0.11) {
      const Eigen::Vector3d place(x, y + 0.06, ditch(y + 0.06));
      const Eigen::Vector3f seen = (place - Eigen::Vector3d(0.07, 0.06, 0)).cast<float>();
      sweep_.points.push_back(seen.x(), seen.y(), seen.z(), 20);
      sweep_.origins.push_back(Eigen::Vector3f(0, 0, 1));
      sweep_.time_ns.push_back(0);
      sweep_.scatter.push_back(0);
      sweep_.is_isolated.push_back(0);
      sweep_.is_moving.push_back(0);
      sweep_.is_suspect.push_back(0);
    }
  }
  registration_.align(sweep_, map_, filter_);
  EXPECT_NEAR(filter_.pose().translation.x(), 0, 0.005);
  EXPECT_NEAR(filter_.pose().translation.y(), 0.06, 0.01);
  EXPECT_GT(filter_.position_deviation().x(), 0.95 * before.x());
  EXPECT_LT(filter_.position_deviation().y(), 0.5 * before.y());
}

TEST_F(RegistrationTest, DoesNothingWithoutAMapOrWithoutPoints) {
  const test::RoughGround rough;
  be_unsure();
  const PoseFilter before = filter_;
  Registration::Outcome outcome = align(rough, {{0.05, 0, 0}, Eigen::Quaterniond::Identity()});
  EXPECT_EQ(outcome.key_points, 0) << "no map";
  learn(rough);
  sweep_.clear();
  outcome = registration_.align(sweep_, map_, filter_);
  EXPECT_EQ(outcome.key_points, 0) << "no points";
  EXPECT_EQ(outcome.rounds, 0);
  EXPECT_EQ(outcome.correction, 0);
  EXPECT_EQ(filter_.pose().translation, before.pose().translation);
  EXPECT_TRUE(filter_.covariance().isApprox(before.covariance(), 1e-9));
}

// What stands where nothing stood pulls at nothing.
TEST_F(RegistrationTest, IsNotLedAstrayByThingsThatAreNew) {
  const test::RoughGround rough;
  learn(rough);
  be_unsure();
  const Pose truth{{0.05, -0.04, 0.02}, from_roll_pitch_yaw(0.008, -0.005, 0.02)};
  test::look(rough, truth, 6, 0.11, sweep_);
  for (double x = 2; x < 4; x += 0.11) {
    for (double y = -1; y < 1; y += 0.11) sweep_.points.push_back(float(x), float(y), 0.25F, 20);
  }
  sweep_.origins.assign(sweep_.points.size(), Eigen::Vector3f(0, 0, 1));
  registration_.align(sweep_, map_, filter_);
  EXPECT_LT((filter_.pose().translation - truth.translation).norm(), 0.015);
  EXPECT_LT(filter_.pose().rotation.angularDistance(truth.rotation), radians(0.3));
}

TEST_F(RegistrationTest, AllocatesNothing) {
  const test::RoughGround rough;
  learn(rough);
  be_unsure();
  const std::size_t before = test::allocations();
  for (int i = 0; i < 5; ++i) align(rough, Pose());
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
