#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "detect/tracked_obstacles.hpp"

namespace scree {
namespace {

TEST_F(TrackerTest, AnObstacleAppearsOnceItWasSeenAgainAndStaysAsItWasFoundLast) {
  EXPECT_EQ(update({at(3, 1)}).size(), 0U) << "seen once";
  ASSERT_EQ(update({at(3, 1)}).size(), 1U);
  const std::int64_t id = list_[0].id;
  EXPECT_GT(id, 0);
  for (int i = 0; i < 50; ++i) {
    Obstacle moved = at(3 + 0.002 * i, 1);
    moved.points = static_cast<std::uint32_t>(i);
    ASSERT_EQ(update({moved}).size(), 1U);
    EXPECT_EQ(list_[0].id, id);
    EXPECT_EQ(list_[0].center, moved.center);
    EXPECT_EQ(list_[0].extent, moved.extent);
    EXPECT_EQ(list_[0].height, moved.height);
    EXPECT_EQ(list_[0].points, moved.points);
    EXPECT_NEAR(list_[0].confidence, 0.9, 1e-3);
  }
}

TEST_F(TrackerTest, IdsStayWithTheirObstaclesWhateverTheOrder) {
  std::vector<Obstacle> found;
  for (int i = 0; i < 8; ++i) found.push_back(i % 2 == 0 ? at(1.5 * i, 0) : hole_at(1.5 * i, 0));
  update(found, 3);
  ASSERT_EQ(list_.size(), 8U);
  std::vector<std::int64_t> ids(8);
  std::set<std::int64_t> different;
  for (const Obstacle& obstacle : list_) {
    const auto place = static_cast<std::size_t>(std::lround(obstacle.center.x() / 1.5));
    ids[place] = obstacle.id;
    different.insert(obstacle.id);
    EXPECT_EQ(obstacle.kind, found[place].kind);
  }
  EXPECT_EQ(different.size(), 8U);
  std::mt19937 random(41);
  std::normal_distribution<double> noise(0, 0.04);
  for (int i = 0; i < 100; ++i) {
    std::vector<Obstacle> shuffled = found;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    for (Obstacle& obstacle : shuffled) {
      obstacle.center += Eigen::Vector3d(noise(random), noise(random), 0);
    }
    ASSERT_EQ(update(shuffled).size(), 8U);
    for (const Obstacle& obstacle : list_) {
      ASSERT_EQ(obstacle.id, ids[static_cast<std::size_t>(std::lround(obstacle.center.x() / 1.5))]);
    }
  }
}

TEST_F(TrackerTest, GoesSoonWhereItsPlaceIsSeenEmptyAndLaterWhereItIsUnseen) {
  std::array<int, 3> lists{};
  for (const Occupancy occupancy : {Occupancy::free, Occupancy::occupied, Occupancy::unknown}) {
    tracker_.clear();
    update({at(3, 1)}, 10);
    occupancy_ = occupancy;
    lists[static_cast<std::size_t>(occupancy)] = updates_until(0, {});
  }
  const auto after = [&](Occupancy occupancy) {
    return lists[static_cast<std::size_t>(occupancy)];
  };
  EXPECT_LE(after(Occupancy::free), 2);
  EXPECT_GE(after(Occupancy::occupied), after(Occupancy::free));
  EXPECT_LE(after(Occupancy::occupied), 5);
  const int remembered = static_cast<int>(settings_.remember * 1e9 / kList);
  EXPECT_GE(after(Occupancy::unknown), remembered);
  EXPECT_LE(after(Occupancy::unknown), remembered + 2);
}

TEST_F(TrackerTest, ComesBackWithItsIdWhenItWasOnlyUnseenForAWhile) {
  update({at(3, 1)}, 5);
  const std::int64_t id = list_[0].id;
  occupancy_ = Occupancy::unknown;
  update({}, 5);
  ASSERT_EQ(list_.size(), 1U) << "still there";
  EXPECT_EQ(list_[0].id, id);
  ASSERT_EQ(update({at(3.05, 1)}).size(), 1U);
  EXPECT_EQ(list_[0].id, id);
}

// What was two in the first lists is one, whose middle wavers.
TEST_F(TrackerTest, OfTwoTracksOnOneThingTheOneThatHadItLastKeepsIt) {
  update({at(3, 1), at(3.15, 1)}, 5);
  ASSERT_EQ(list_.size(), 2U);
  const auto one_of_them = [](int i) { return at(i % 2 == 0 ? 3.05 : 3.12, 1); };
  for (int i = 0; i < 8; ++i) update({one_of_them(i)});
  ASSERT_EQ(list_.size(), 1U);
  const std::int64_t id = list_[0].id;
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(update({one_of_them(i)}).size(), 1U) << i;
    EXPECT_EQ(list_[0].id, id) << i;
  }
}

TEST_F(TrackerTest, TheMiddleOfAHoleIsEmptyAsLongAsItIsThere) {
  update({hole_at(3, 1)}, 10);
  occupancy_ = Occupancy::free;
  EXPECT_GT(updates_until(0, {}), 2);
}

// A confidence that wavers about a threshold does not make the obstacle come and go.
TEST_F(TrackerTest, WhatStandsUpIsNeverAHole) {
  // Something that stands up, which the network takes for a hole now and then.
  Obstacle doubtful = at(3, 1, 0.6F);
  doubtful.kind = ObstacleKind::negative;
  update({at(3, 1)}, 5);
  const std::int64_t id = list_[0].id;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(update({i % 4 == 0 ? doubtful : at(3, 1)}).size(), 1U);
    EXPECT_EQ(list_[0].kind, ObstacleKind::positive) << i;
    EXPECT_EQ(list_[0].id, id);
  }
  doubtful.confidence = 0.9F;
  for (int i = 0; i < 10; ++i) {
    for (const Obstacle& each : update({doubtful})) {
      EXPECT_EQ(each.kind, ObstacleKind::positive) << i;
    }
  }
  EXPECT_EQ(list_.size(), 0U) << "it is believed no longer";
}

TEST_F(TrackerTest, AHoleBesideAMoundIsAnother) {
  update({at(3, 1), hole_at(3.4, 1.1)}, 4);
  ASSERT_EQ(list_.size(), 2U);
  EXPECT_NE(list_[0].id, list_[1].id);
  EXPECT_NE(list_[0].kind, list_[1].kind);
}

TEST_F(TrackerTest, PartsThatBecomeOneAndAPartThatSplitsOffKeepOneId) {
  update({at(3, 1), at(3.5, 1.15)}, 5);
  ASSERT_EQ(list_.size(), 2U);
  const std::set<std::int64_t> ids{list_[0].id, list_[1].id};
  Obstacle whole = at(3.25, 1.08);
  whole.extent = {1.1, 0.4, 0.4};
  EXPECT_LT(updates_until(1, {whole}), 6) << "no ghost of the other part stays";
  ASSERT_EQ(list_.size(), 1U);
  const std::int64_t id = list_[0].id;
  EXPECT_TRUE(ids.count(id));
  EXPECT_EQ(list_[0].extent, whole.extent);

  update({at(3, 1), at(3.5, 1.15)}, 5);
  ASSERT_EQ(list_.size(), 2U);
  EXPECT_NE(list_[0].id, list_[1].id);
  EXPECT_TRUE(list_[0].id == id || list_[1].id == id);
}

TEST_F(TrackerTest, LongThingsAreMatchedByTheirBoxesNotByTheirCentres) {
  // A log of 4 m of which now this, now that part is seen.
  Obstacle log = at(3, 0);
  log.yaw = 1.2;
  log.extent = {4, 0.3, 0.3};
  update({log}, 4);
  ASSERT_EQ(list_.size(), 1U);
  const std::int64_t id = list_[0].id;
  log.center += 1.2 * Eigen::Vector3d(std::cos(1.2), std::sin(1.2), 0);
  log.extent.x() = 1.6;
  ASSERT_EQ(update({log}).size(), 1U);
  EXPECT_EQ(list_[0].id, id);
  // Beside the log's middle, and out of its box.
  Obstacle stone = log;
  stone.center += 0.9 * Eigen::Vector3d(-std::sin(1.2), std::cos(1.2), 0);
  stone.extent = {0.3, 0.3, 0.3};
  update({log, stone}, 4);
  EXPECT_EQ(list_.size(), 2U);
}

TEST_F(TrackerTest, DropsAndCountsWhatFindsNoRoom) {
  std::vector<Obstacle> many;
  for (int i = 0; i < 40; ++i) many.push_back(at(1.5 * i, 0));
  update(many, 3);
  EXPECT_EQ(list_.size(), kMost);
  EXPECT_EQ(tracker_.dropped(), 3 * (40 - kMost));
  // All of one heap: more pairs than are compared.
  tracker_.clear();
  const std::uint64_t before = tracker_.dropped();
  update(std::vector<Obstacle>(kMost, at(3, 1)), 20);
  EXPECT_LE(list_.size(), kMost);
  EXPECT_GE(tracker_.dropped(), before);

  FixedVector<Obstacle> small(2);
  tracker_.clear();
  many.resize(5);
  for (int i = 0; i < 3; ++i) {
    tracker_.update(
        now_ns_ += kList, robot_, many, [](const Eigen::Vector3d&) { return Occupancy::occupied; },
        small);
  }
  EXPECT_EQ(small.size(), 2U);
  EXPECT_GT(tracker_.dropped(), before);
}

TEST_F(TrackerTest, WhatIsNearestFindsRoom) {
  std::vector<Obstacle> far, near;
  for (std::size_t i = 0; i < kMost; ++i) far.push_back(at(30 + 1.5 * static_cast<double>(i), 0));
  for (std::size_t i = 0; i < kMost; ++i) near.push_back(at(1.5 * static_cast<double>(i), 0));
  update(far, 3);
  ASSERT_EQ(list_.size(), kMost);
  update(near, 3);
  ASSERT_EQ(list_.size(), kMost);
  for (const Obstacle& obstacle : list_) EXPECT_LT(obstacle.center.x(), 30);
}

// Also when the stamps of two lists are the same.
TEST_F(TrackerTest, OfSweepsWhatIsFoundIsPublishedAtOnceAndGoneWithTheNextList) {
  tracker_ = Tracker(TrackingSettings::for_sweep(), kMost);
  occupancy_ = Occupancy::unknown;
  const auto list_of = [&](const std::vector<Obstacle>& found) {
    now_ns_ = kStart;
    update(found);
    std::set<std::int64_t> ids;
    for (const Obstacle& obstacle : list_) ids.insert(obstacle.id);
    return ids;
  };
  const std::set<std::int64_t> first = list_of({at(3, 1, 0.7F), hole_at(6, 1, 0.7F)});
  EXPECT_EQ(first.size(), 2U);
  EXPECT_EQ(list_of({at(3.1, 1, 0.7F), hole_at(6.1, 1, 0.7F)}), first);
  EXPECT_FLOAT_EQ(list_[0].confidence, 0.7F);
  EXPECT_EQ(list_of({at(3.2, 1, 0.7F)}).size(), 1U);
  EXPECT_EQ(list_of({}).size(), 0U);
  EXPECT_FALSE(first.contains(*list_of({at(3.2, 1, 0.7F)}).begin())) << "it was gone";
}

// Were the time of the last finding ahead for hours, what is unseen would stay so long.
TEST_F(TrackerTest, GoesOnWhenTheClockIsSet) {
  for (const std::int64_t shift : {-36'000 * kList, 36'000 * kList}) {
    tracker_.clear();
    update({at(3, 1), at(9, 1)}, 5);
    const std::int64_t id = list_[0].id;
    now_ns_ += shift;
    occupancy_ = Occupancy::unknown;
    update({at(3, 1)}, 20);
    ASSERT_EQ(list_.size(), 1U);
    EXPECT_EQ(list_[0].id, id);
  }
}

/// Also when a turn has several lists.
TEST_F(TrackerTest, AnObstacleComesAndGoesInAsManyTurns) {
  const int turns_to_come = updates_until(1, {at(3, 1, 0.5F)}), turns_to_go = updates_until(0, {});
  occupancy_ = Occupancy::free;
  updates_until(1, {at(3, 1, 0.5F)});
  const int turns_to_go_empty = updates_until(0, {});
  for (const int lists : {2, 4, 8}) {
    tracker_.clear();
    occupancy_ = Occupancy::occupied;
    turns_ = 1 / static_cast<float>(lists);
    SCOPED_TRACE(testing::Message() << lists << " lists a turn");
    EXPECT_EQ(updates_until(1, {at(3, 1, 0.5F)}), lists * (turns_to_come - 1) + 1);
    EXPECT_NEAR(updates_until(0, {}), lists * turns_to_go, lists);
    occupancy_ = Occupancy::free;
    updates_until(1, {at(3, 1, 0.5F)});
    EXPECT_NEAR(updates_until(0, {}), lists * turns_to_go_empty, lists);
  }
}

TEST_F(TrackerTest, ATracksFeaturesAreWhatTheySayTheyAre) {
  Obstacle first = at(3, 1, 0.8F), then = at(3, 1, 0.5F), surer = at(3.6, 1.8);
  then.height = 0.3;
  surer.center.z() = 7;
  update({first, surer});
  update({then, surer});
  ASSERT_EQ(tracker_.tracks().size(), 2U);
  const Tracker::Track& track = tracker_.tracks()[0];
  EXPECT_EQ(track.found, 2);
  // The first two answers count alike.
  EXPECT_NEAR(track.features[track_positive], 0.65, 1e-6);
  EXPECT_EQ(track.features[track_negative], 0);
  EXPECT_NEAR(track.smoothed(), 0.65, 1e-6);
  EXPECT_FLOAT_EQ(track.features[track_best], 0.8F);
  EXPECT_FLOAT_EQ(track.features[track_height], 0.3F);
  EXPECT_NEAR(track.features[track_surer], 1, 1e-6) << "on the ground, not upwards";
  EXPECT_EQ(tracker_.tracks()[1].features[track_surer], 3) << "none is surer";
  update({surer});
  EXPECT_LT(tracker_.tracks()[0].features[track_positive], 0.65);
  EXPECT_FLOAT_EQ(tracker_.tracks()[0].features[track_best], 0.8F);
}

}  // namespace
}  // namespace scree
