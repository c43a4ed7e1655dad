#include "scree/detect/moving_tracker.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "detect/boxes.hpp"

namespace scree {
namespace {

constexpr std::int64_t kTurnNs = 100'000'000;

class MovingTrackerTest : public testing::Test {
protected:
  static Obstacle person(double x, double y) { return box(x, y, 0.4, 0.4, 60); }

  /// The moving obstacles of the next list, in which `standing` are those that stand.
  std::vector<Obstacle> update(const std::vector<Obstacle>& found,
                               const std::vector<Obstacle>& standing = {}) {
    now_ns_ += kTurnNs;
    tracker_.update(
        now_ns_, found, [this](const Eigen::Vector3d&) { return is_seen_through_; }, next_id_);
    list_.clear();
    for (const Obstacle& each : standing) list_.push_back(each);
    tracker_.add_to(list_, Eigen::Vector3d::Zero(), standing_);
    return {list_.begin(), list_.end()};
  }

  MovingTracker tracker_{16};
  Tracker standing_{TrackingSettings::for_sweep(), 16};
  FixedVector<Obstacle> list_{8};
  std::int64_t now_ns_ = 1'598'612'523'000'000'000, next_id_ = 40;
  bool is_seen_through_ = false;
};

TEST_F(MovingTrackerTest, IsPublishedFromTheSecondSweepOnWithAnIdThatStays) {
  EXPECT_TRUE(update({person(5, 0)}).empty());
  for (int i = 1; i < 60; ++i) {
    const auto list = update({person(5, 0.13 * i)});
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].id, 40);
    EXPECT_NEAR(list[0].center.y(), 0.13 * i, 1e-9);
  }
  EXPECT_EQ(next_id_, 41);
}

TEST_F(MovingTrackerTest, TheVelocityIsRightAfterHalfASecondAndZeroForWhatStands) {
  for (int i = 0; i < 30; ++i) {
    const double off = i % 2 == 0 ? 0.03 : -0.03;  // another side of it is seen
    const auto list = update({person(5 - 0.05 * i, 0.12 * i + off), person(-5 + off, 0)});
    if (i < 5) continue;
    ASSERT_EQ(list.size(), 2U);
    EXPECT_NEAR((list[0].velocity - Eigen::Vector2d(-0.5, 1.2)).norm(), 0, 0.25) << i;
    EXPECT_EQ(list[1].velocity, Eigen::Vector2d(0, 0));
  }
}

TEST_F(MovingTrackerTest, BehindSomethingItGoesOnAsItWent) {
  for (int i = 0; i < 20; ++i) update({person(5, 0.1 * i)});
  for (int i = 20; i < 32; ++i) {
    const auto list = update({});
    ASSERT_EQ(list.size(), 1U) << i;
    EXPECT_NEAR(list[0].center.y(), 0.1 * i, 0.1);
  }
  EXPECT_EQ(update({person(5, 3.2)}).at(0).id, 40);
  for (int i = 0; i < 16; ++i) update({});
  EXPECT_TRUE(update({}).empty()) << "not for ever";
}

TEST_F(MovingTrackerTest, IsGoneSoonAfterLightGoesThroughItsPlace) {
  for (int i = 0; i < 20; ++i) update({person(5, 0.1 * i)});
  is_seen_through_ = true;
  update({});
  EXPECT_TRUE(update({}).empty());
}

TEST_F(MovingTrackerTest, WhoComesToStandKeepsTheId) {
  for (int i = 0; i < 20; ++i) update({person(5, 0.1 * std::min(i, 10))});
  Obstacle there = person(5.1, 1);
  const auto both = update({person(5, 1)}, {there});
  ASSERT_EQ(both.size(), 1U) << "one obstacle, while the map begins to have it";
  EXPECT_EQ(both[0].id, 40);
  const auto list = update({}, {there});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].id, 40);
  EXPECT_EQ(list[0].center, there.center) << "the map's";
  EXPECT_TRUE(tracker_.tracks().empty());
}

TEST_F(MovingTrackerTest, WhatStandsBesideItsWayStays) {
  const Obstacle rock = box(5.6, 1, 0.5, 0.5, 60);
  for (int i = 0; i < 20; ++i) {
    const auto list = update({person(5, 0.1 * i)}, {rock});
    ASSERT_GE(list.size(), 1U);
    EXPECT_EQ(list[0].id, rock.id);
  }
}

TEST_F(MovingTrackerTest, KnowsWhatItCameFrom) {
  const Obstacle left = person(5.1, 0), there = person(5, 1), beside = person(6, 0.5);
  for (int i = 0; i < 3; ++i) {
    update({person(5, 0.05 * i)});
    EXPECT_FALSE(tracker_.was_left(left)) << i;
  }
  for (int i = 3; i < 21; ++i) update({person(5, 0.05 * i)});
  EXPECT_TRUE(tracker_.was_left(left));
  EXPECT_FALSE(tracker_.was_left(there)) << "it is there";
  EXPECT_FALSE(tracker_.was_left(beside));
  EXPECT_TRUE(tracker_.was_left(person(5.3, -0.8))) << "where it stood before it was seen to move";
  EXPECT_FALSE(tracker_.was_left(person(5, -1.8)));
}

TEST_F(MovingTrackerTest, MoreThanItHasRoomForAreCounted) {
  std::vector<Obstacle> found;
  for (int i = 0; i < 20; ++i) found.push_back(person(5, 2 * i));
  update(found);
  update(found);
  EXPECT_GT(tracker_.dropped(), 0U);
  EXPECT_EQ(list_.size(), list_.capacity());
}

}  // namespace
}  // namespace scree
