#include <gtest/gtest.h>

#include "motion_steps.hpp"
#include "scree/core/rotation.hpp"
#include "scree/motion/pose_filter.hpp"

namespace scree {
namespace {

using test::ahead;
using test::step_of;

/// The i-th step of 0.1 s while the IMU's yaw turns at this rate.
MotionStep yawing(double yaw_rate, int i, double way) {
  return step_of(from_roll_pitch_yaw(0, 0, 0.1 * yaw_rate * i),
                 from_roll_pitch_yaw(0, 0, 0.1 * yaw_rate * (i + 1)), way);
}

/// For 3 s on the spot, the IMU's yaw turning at this rate.
PoseFilter on_the_spot(double yaw_rate, double way_a_step = 0, bool knows_distance = true) {
  PoseFilter filter;
  filter.predict(ahead(0));
  for (int i = 0; i < 30; ++i) {
    MotionStep step = yawing(yaw_rate, i, way_a_step);
    step.knows_distance = knows_distance;
    filter.predict(step);
  }
  return filter;
}

TEST(PoseFilterKnowledge, StandingItKeepsItsYawAndLearnsTheDrift) {
  for (const double rate : {0.002, -0.003}) {
    PoseFilter filter = on_the_spot(rate);
    EXPECT_LT(std::abs(yaw_of(filter.pose().rotation)), std::abs(rate) * 0.4) << rate;
    EXPECT_NEAR(filter.yaw_drift(), -rate, 0.1 * std::abs(rate));
    // Driving off, with the IMU drifting on.
    for (int i = 30; i < 130; ++i) filter.predict(yawing(rate, i, 0.1));
    EXPECT_LT(std::abs(yaw_of(filter.pose().rotation)), std::abs(rate) * 1.5) << rate;
  }
}

TEST(PoseFilterKnowledge, StandingItIsNoLessSureOfItsYaw) {
  const PoseFilter standing = on_the_spot(0), creeping = on_the_spot(0, 0.003);
  EXPECT_LT(standing.rotation_deviation().z(), 0.3 * creeping.rotation_deviation().z());
  EXPECT_LT(standing.covariance()(7, 7), 0.2 * creeping.covariance()(7, 7));
}

TEST(PoseFilterKnowledge, WhatTurnsOrRollsOrMayRollDoesNotStand) {
  EXPECT_NEAR(yaw_of(on_the_spot(0.02).pose().rotation), 0.06, 1e-6) << "turns on the spot";
  EXPECT_NEAR(yaw_of(on_the_spot(0.005, 0.003).pose().rotation), 0.015, 1e-6) << "creeps";
  EXPECT_NEAR(yaw_of(on_the_spot(0.005, 0, false).pose().rotation), 0.015, 1e-6)
      << "the wheel is silent";
}

TEST(PoseFilterKnowledge, SilenceMakesItUnsureOfJustWhatIsMissing) {
  PoseFilter with, no_imu, no_wheel;
  for (PoseFilter* filter : {&with, &no_imu, &no_wheel}) filter->predict(ahead(0));
  for (int i = 0; i < 20; ++i) {
    MotionStep step = ahead(0.1);
    with.predict(step);
    step.knows_attitude = false;
    no_imu.predict(step);
    step.knows_attitude = true;
    step.knows_distance = false;
    no_wheel.predict(step);
  }
  EXPECT_GT(no_imu.rotation_deviation().z(), 5 * with.rotation_deviation().z());
  EXPECT_GT(no_imu.rotation_deviation().x(), 2 * with.rotation_deviation().x());
  EXPECT_NEAR(no_imu.position_deviation().x(), with.position_deviation().x(), 0.01);
  EXPECT_GT(no_wheel.position_deviation().x(), 2 * with.position_deviation().x());
  EXPECT_NEAR(no_wheel.rotation_deviation().z(), with.rotation_deviation().z(), 1e-6);
}

/// Straight on for 2 s; then the IMU is silent and the robot believed to turn by `wrong` in all;
/// then the IMU is back with `yaw`. Known before at all, or not.
/// @param seen standard deviation of the yaw that registration knows meanwhile, rad; 0 none
Pose silence(double wrong, double yaw, bool was_known, PoseFilter& filter, double seen = 0) {
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 40; ++i) {
    const bool is_silent = i >= 20;
    const Eigen::Quaterniond next =
        is_silent ? attitude * exponential({0, 0, wrong / 20}) : attitude;
    MotionStep step = step_of(attitude, next, 0.1);
    step.knows_attitude = was_known && !is_silent;
    filter.predict(step);
    attitude = next;
    if (seen == 0) continue;
    PoseEvidence evidence;
    evidence.information(5, 5) = 1 / (seen * seen);
    filter.begin_update();
    filter.update(evidence);
    filter.end_update(evidence);
  }
  const Pose before = filter.pose();
  // Standing; dead reckoning gives the begin in the frame of the end.
  const Eigen::Quaterniond heard = from_roll_pitch_yaw(0, 0, yaw);
  filter.predict(step_of(heard, heard, 0));
  return before;
}

TEST(PoseFilterKnowledge, GoesOnFromAPoseByAnotherImu) {
  const Pose here{{3, -2, 0.5}, from_roll_pitch_yaw(0.1, 0.05, 0.7)};
  PoseFilter filter(here);
  filter.predict(step_of(from_roll_pitch_yaw(0, 0.02, -2), from_roll_pitch_yaw(0, 0.02, -1.9), 1));
  const Pose& pose = filter.pose();
  EXPECT_NEAR(yaw_of(pose.rotation), 0.8, 1e-9);
  EXPECT_LT(pose.rotation.angularDistance(from_roll_pitch_yaw(0, 0.02, 0.8)), 1e-9);
  const Eigen::Vector3d way = pose.translation - here.translation;
  EXPECT_NEAR(way.norm(), 1, 1e-9);
  EXPECT_NEAR(std::atan2(way.y(), way.x()), 0.75, 1e-3);
}

TEST(PoseFilterKnowledge, AnImuThatGoesOnAfterSilenceIsBelieved) {
  PoseFilter filter;
  const Pose before = silence(0.2, 0, true, filter);
  EXPECT_NEAR(yaw_of(before.rotation), 0.2, 1e-6);
  EXPECT_NEAR(yaw_of(filter.pose().rotation), 0, 1e-3);
  EXPECT_EQ(filter.pose().translation, before.translation);
  EXPECT_LT(filter.rotation_deviation().z(), 0.02);
}

TEST(PoseFilterKnowledge, AnImuThatStartedOverKeepsTheYawThatWasBelieved) {
  for (const double yaw : {2.0, -3.0, 1.0}) {
    PoseFilter filter;
    const Pose before = silence(0.2, yaw, true, filter);
    EXPECT_NEAR(yaw_of(filter.pose().rotation), 0.2, 1e-3) << yaw;
    EXPECT_EQ(filter.pose().translation, before.translation);
    EXPECT_GT(filter.rotation_deviation().z(), 0.1) << "what was believed in silence is unsure";
    filter.predict(step_of(from_roll_pitch_yaw(0, 0, yaw), from_roll_pitch_yaw(0, 0, yaw), 1));
    const Eigen::Vector3d moved = filter.pose().translation - before.translation;
    EXPECT_NEAR(std::atan2(moved.y(), moved.x()), 0.2, 1e-3) << yaw;
  }
}

TEST(PoseFilterKnowledge, AnImuThatStartedOverALittleOffIsToldByWhatWasSeenMeanwhile) {
  for (const double off : {0.17, -0.35, 0.1}) {
    PoseFilter filter;
    silence(0.2, 0.2 + off, true, filter, 0.01);
    EXPECT_NEAR(yaw_of(filter.pose().rotation), 0.2, 0.01) << off;
  }
  PoseFilter filter;
  silence(0.2, 0.18, true, filter, 0.01);
  EXPECT_NEAR(yaw_of(filter.pose().rotation), 0.18, 0.002) << "it went on";
}

TEST(PoseFilterKnowledge, AnImuHeardLateKeepsTheYawAndSetsTheTilt) {
  for (const double yaw : {0.3, 2.0}) {
    PoseFilter filter;
    silence(0, yaw, false, filter);
    EXPECT_NEAR(yaw_of(filter.pose().rotation), 0, 1e-3) << yaw;
    const auto leaning = from_roll_pitch_yaw(0.1, 0.2, yaw);
    filter.predict(step_of(leaning, leaning, 0));
    EXPECT_LT(filter.pose().rotation.angularDistance(from_roll_pitch_yaw(0.1, 0.2, 0)), 1e-3);
  }
}

}  // namespace
}  // namespace scree
