#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "detect/tracked_obstacles.hpp"

namespace scree {
namespace {

TEST_F(TrackerTest, WhatIsHardlyBelievedNeverAppears) {
  EXPECT_EQ(updates_until(1, {at(3, 1, 0.12F)}), 100);
}

TEST_F(TrackerTest, OneListOfDoubtWithdrawsNothing) {
  occupancy_ = Occupancy::occupied;
  ASSERT_EQ(update({at(3, 1)}, 20).size(), 1U);
  const std::int64_t id = list_[0].id;
  for (int i = 0; i < 2; ++i) {
    int lists = 0;  // until it is doubted
    do {
      ASSERT_EQ(update({}).size(), 1U);
      ASSERT_LT(++lists, 10);
    } while (list_[0].confidence >= settings_.disappear);
    ASSERT_EQ(update({at(3, 1)}, 20).size(), 1U);
    EXPECT_EQ(list_[0].id, id);
  }
  EXPECT_LE(updates_until(0, {}), 5) << "but it goes";
}

TEST_F(TrackerTest, DoesNotFlicker) {
  std::mt19937 random(42);
  std::uniform_real_distribution<float> wavering(0.1F, 0.8F);
  update({at(3, 1)}, 5);
  int changes = 0, raw_changes = 0;
  bool was_listed = true, was_sure = true;
  std::set<std::int64_t> ids;
  for (int i = 0; i < 300; ++i) {
    const float confidence = wavering(random);
    const bool is_listed = update({at(3, 1, confidence)}).size() == 1;
    const bool is_sure = confidence >= static_cast<float>(settings_.appear);
    changes += is_listed != was_listed ? 1 : 0;
    raw_changes += is_sure != was_sure ? 1 : 0;
    was_listed = is_listed;
    was_sure = is_sure;
    if (is_listed) ids.insert(list_[0].id);
  }
  EXPECT_GT(raw_changes, 60);
  EXPECT_LT(changes, raw_changes / 5);
  EXPECT_EQ(ids.size(), 1U);
}

TEST_F(TrackerTest, AMissedListChangesNothing) {
  update({at(3, 1)}, 10);
  const std::int64_t id = list_[0].id;
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(update({}).size(), 1U) << i;
    EXPECT_EQ(list_[0].id, id);
    ASSERT_EQ(update({at(3, 1)}, 3).size(), 1U) << i;
  }
}

TEST_F(TrackerTest, AnObstacleTooFarOffIsFollowedAndPublishedAtOnceWhenTheRobotIsNearEnough) {
  const double reach = settings_.reach;
  EXPECT_EQ(update({at(reach + 0.5, 0), at(0, -reach - 0.5)}, 10).size(), 0U);
  robot_ = {1, 0, 0};
  ASSERT_EQ(update({at(reach + 0.5, 0), at(0, -reach - 0.5)}).size(), 1U);
  EXPECT_NEAR(list_[0].center.x(), reach + 0.5, 1e-9);
  const std::int64_t id = list_[0].id;
  robot_ = {0, 0, 0};
  EXPECT_EQ(update({at(reach + 0.5, 0)}).size(), 1U) << "it does not come and go at the reach";
  robot_ = {-0.5, 0, 0};
  EXPECT_EQ(update({at(reach + 0.5, 0)}).size(), 0U);
  robot_ = {0, 0, 0};
  EXPECT_EQ(update({at(reach + 0.5, 0)}).size(), 0U);
  robot_ = {1, 0, 0};
  ASSERT_EQ(update({at(reach + 0.5, 0)}).size(), 1U);
  EXPECT_EQ(list_[0].id, id);
}

TEST_F(TrackerTest, AnObstacleOfWhichAPartIsNearEnoughIsPublished) {
  const double reach = settings_.reach;
  Obstacle ditch = hole_at(reach + 0.9, 0);
  ditch.extent = {2, 6, 0.4};
  ditch.yaw = 0;
  ASSERT_EQ(update({ditch}, 2).size(), 1U);
  ditch.center.x() = reach + 1.4;
  EXPECT_EQ(update({ditch}).size(), 0U);
}

TEST_F(TrackerTest, WhatWheelsPassIsFollowedAndPublishedWhenItIsFoundHigher) {
  settings_.least_height = 0.12;
  tracker_.set(settings_);
  const auto of_height = [](double height) {
    Obstacle obstacle = height > 0 ? at(3, 1) : hole_at(3, 1);
    obstacle.height = height;
    if (height < 0) obstacle.evidence = Evidence::inside;
    return obstacle;
  };
  for (const double side : {1.0, -1.0}) {
    tracker_.clear();
    EXPECT_EQ(update({of_height(0.11 * side)}, 10).size(), 0U);
    ASSERT_EQ(tracker_.tracks().size(), 1U);
    EXPECT_EQ(update({of_height(0.13 * side)}).size(), 1U) << "it was long known";
    const std::int64_t id = list_[0].id;
    for (int i = 0; i < 10; ++i) {
      ASSERT_EQ(update({of_height((i % 2 == 0 ? 0.1 : 0.13) * side)}).size(), 1U);
      EXPECT_EQ(list_[0].id, id);
    }
    EXPECT_EQ(update({of_height(0.08 * side)}).size(), 0U);
  }
  Obstacle kerb = of_height(0.07), hole = of_height(-0.07);
  kerb.extent.x() = 1.2;
  hole.evidence = Evidence::wall;
  for (Obstacle* const each : {&kerb, &hole}) {
    tracker_.clear();
    EXPECT_EQ(update({*each}, 2).size(), 1U) << "it may be more than it looks";
    tracker_.clear();
    each->height *= 0.5;
    EXPECT_EQ(update({*each}, 2).size(), 0U);
  }
}

}  // namespace
}  // namespace scree
