#include "scoring/scoring.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

using testing::ElementsAre;

constexpr auto kRock = ObstacleKind::positive;
constexpr auto kHole = ObstacleKind::negative;

/// A square of 1 m about (x, y).
TrueObstacle there(int id, double x, double y, ObstacleKind kind = kRock) {
  return {id,
          kind,
          {x, y, 0},
          {{x - 0.5, y - 0.5}, {x + 0.5, y - 0.5}, {x + 0.5, y + 0.5}, {x - 0.5, y + 0.5}},
          kind == kRock ? 0.4 : -0.4,
          ""};
}

Obstacle seen(double x, double y, ObstacleKind kind = kRock, double size = 0.2) {
  Obstacle obstacle;
  obstacle.kind = kind;
  obstacle.center = {x, y, 0};
  obstacle.extent = {size, size, 0.4};
  obstacle.height = kind == kRock ? 0.4 : -0.4;
  return obstacle;
}

ObstacleList list_of(std::vector<Obstacle> obstacles, std::int64_t stamp_ns = 0, Pose pose = {}) {
  ObstacleList list(obstacles.size());
  list.stamp_ns = stamp_ns;
  list.pose = pose;
  for (const Obstacle& obstacle : obstacles) list.obstacles.push_back(obstacle);
  return list;
}

/// A robot at rest at the origin, one sweep.
Truth standing(std::vector<TrueObstacle> obstacles, std::vector<int> ids,
               std::vector<int> ignore = {}) {
  return {std::move(obstacles), {{0, Pose()}}, {{0, std::move(ids), std::move(ignore)}}};
}

ScoringResult score(const Truth& truth, std::vector<Obstacle> obstacles) {
  Scorer scorer;
  const ObstacleList list = list_of(std::move(obstacles));
  scorer.add(truth, {&list, 1});
  return scorer.result();
}

std::vector<std::size_t> counts(const Score& score) {
  return {score.true_positives, score.false_positives, score.false_negatives};
}

TEST(Scoring, ACentreInsideTheGrownFootprintMatches) {
  const Truth truth = standing({there(1, 5, 0)}, {1});
  EXPECT_THAT(counts(score(truth, {seen(5.79, 0)}).scores.all()), ElementsAre(1, 0, 0));
  EXPECT_THAT(counts(score(truth, {seen(5.81, 0)}).scores.all()), ElementsAre(0, 1, 1));
  // Grown by a disc: beyond a corner 0.3 m are 0.3 m.
  EXPECT_THAT(counts(score(truth, {seen(5.71, 0.71)}).scores.all()), ElementsAre(1, 0, 0));
  EXPECT_THAT(counts(score(truth, {seen(5.72, 0.72)}).scores.all()), ElementsAre(0, 1, 1));
}

TEST(Scoring, OrFootprintsThatOverlapByAFifth) {
  const Truth truth = standing({there(1, 5, 0)}, {1});
  // 2 m wide, 1 m deep, 0.9 m beside: 0.6 of 2.4 square metres shared, and then 0.45 of 2.55.
  Obstacle beside = seen(5, 0.9);
  beside.extent = {1, 2, 1};
  EXPECT_THAT(counts(score(truth, {beside}).scores.all()), ElementsAre(1, 0, 0));
  beside.center.y() = 1.05;
  EXPECT_THAT(counts(score(truth, {beside}).scores.all()), ElementsAre(0, 1, 1));
}

TEST(Scoring, AFootprintCountsInsteadOfTheBox) {
  const Truth truth = standing({there(1, 5, 0)}, {1});
  Obstacle beside = seen(5, 0.9);
  EXPECT_THAT(counts(score(truth, {beside}).scores.all()), ElementsAre(0, 1, 1));
  // 1.1 m wide, 1.6 m long: 0.7 of 2.06 square metres shared.
  for (const auto& [x, y] : {std::pair{4.5, -0.2}, {5.6, -0.2}, {5.6, 1.4}, {4.5, 1.4}}) {
    beside.footprint.push_back({x, y});
  }
  EXPECT_THAT(counts(score(truth, {beside}).scores.all()), ElementsAre(1, 0, 0));
  // It moves with the robot.
  Scorer scorer;
  const Pose pose{{0, 100, 0}, from_roll_pitch_yaw(0, 0, 0)};
  beside.center.y() += 100;
  for (Eigen::Vector2d& corner : beside.footprint) corner.y() += 100;
  const ObstacleList list = list_of({beside}, 0, pose);
  scorer.add(truth, {&list, 1});
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(1, 0, 0));
}

TEST(Scoring, TheBoxIsTurnedByItsYaw) {
  const Truth truth = standing({there(1, 5, 0)}, {1});
  Obstacle slab = seen(5, 0.9);
  slab.extent = {2, 1, 1};
  EXPECT_THAT(counts(score(truth, {slab}).scores.all()), ElementsAre(0, 1, 1));
  slab.yaw = std::numbers::pi / 2;
  EXPECT_THAT(counts(score(truth, {slab}).scores.all()), ElementsAre(1, 0, 0));
}

TEST(Scoring, MatchesAreOneToOneNearestFirst) {
  const Truth truth = standing({there(1, 5, 0), there(2, 5, 1.2)}, {1, 2});
  // The first could match both; it is nearer to the second, so the other one gets the first.
  EXPECT_THAT(counts(score(truth, {seen(5, 0.7), seen(5, -0.3)}).scores.all()),
              ElementsAre(2, 0, 0));
  // Two on one obstacle: the nearer counts, the other is a false positive.
  EXPECT_THAT(counts(score(truth, {seen(5, 0.1), seen(5, 0)}).scores.all()), ElementsAre(1, 1, 1));
}

TEST(Scoring, ObstaclesAreMatchedWhateverTheKind) {
  const Truth truth = standing({there(1, 5, 0, kRock)}, {1});
  // The nearer one is of the wrong kind and takes the obstacle from the right one.
  const ScoringResult result = score(truth, {seen(5, 0.1, kHole), seen(5, 0.2, kRock)});
  EXPECT_THAT(counts(result.scores.positive), ElementsAre(0, 1, 1));
  EXPECT_THAT(counts(result.scores.negative), ElementsAre(0, 1, 0));
}

TEST(Scoring, AWrongKindIsOneFalsePositiveAndOneFalseNegative) {
  const ScoringResult result = score(standing({there(1, 5, 0, kRock)}, {1}), {seen(5, 0, kHole)});
  EXPECT_THAT(counts(result.scores.positive), ElementsAre(0, 0, 1));
  EXPECT_THAT(counts(result.scores.negative), ElementsAre(0, 1, 0));
}

TEST(Scoring, ADetectionLeftOverIsIgnoredWhereTheNearestIs) {
  const Truth ignored = standing({there(1, 5, 0)}, {}, {1});
  EXPECT_THAT(counts(score(ignored, {seen(5, 0), seen(5, 0.2, kHole)}).scores.all()),
              ElementsAre(0, 0, 0));
  EXPECT_THAT(counts(score(ignored, {seen(8, 0)}).scores.all()), ElementsAre(0, 1, 0));
  // Nearest is one that was asked for, and is taken: a false positive, though an ignored one is
  // within reach.
  const Truth mixed = standing({there(1, 5, 0), there(2, 5, 1.2)}, {1}, {2});
  EXPECT_THAT(counts(score(mixed, {seen(5, 0), seen(5, 0.55)}).scores.all()), ElementsAre(1, 1, 0));
  EXPECT_THAT(counts(score(mixed, {seen(5, 0), seen(5, 0.65)}).scores.all()), ElementsAre(1, 0, 0));
  // One that the sweep names in neither list.
  const Truth unnamed = standing({there(1, 5, 0)}, {});
  EXPECT_THAT(counts(score(unnamed, {seen(5, 0)}).scores.all()), ElementsAre(0, 1, 0));
}

TEST(Scoring, AskedObstaclesComeBeforeIgnoredOnes) {
  // The only detection is nearer to the ignored obstacle, but it can match the one asked for.
  const Truth truth = standing({there(1, 5, 0), there(2, 5, 1.2)}, {1}, {2});
  EXPECT_THAT(counts(score(truth, {seen(5, 0.75)}).scores.all()), ElementsAre(1, 0, 0));
}

TEST(Scoring, TruthAndDetectionsMeetInBase) {
  // The robot stands at (10, 0) and looks along world y; its odometry begins where it stands.
  Truth truth = standing({there(1, 10, 5)}, {1});
  truth.poses[0].base.translation = {10, 0, 0};
  truth.poses[0].base.rotation = from_roll_pitch_yaw(0, 0, std::numbers::pi / 2);
  EXPECT_THAT(counts(score(truth, {seen(5, 0)}).scores.all()), ElementsAre(1, 0, 0));
  // With a drifted reported pose the same detection lies elsewhere in base.
  Scorer scorer;
  Pose drifted;
  drifted.translation = {3, 0, 0};
  const ObstacleList list = list_of({seen(8, 0)}, 0, drifted);
  scorer.add(truth, {&list, 1});
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(1, 0, 0));
}

TEST(Scoring, TheTruePoseIsThatOfTheListsStamp) {
  Truth truth = standing({there(1, 10, 0)}, {1});
  truth.poses = {{0, Pose()}, {kSecond, {{10, 0, 0}, Eigen::Quaterniond::Identity()}}};
  truth.visible = {{500 * kMillisecond, {1}, {}}, {2 * kSecond, {}, {}}};
  Scorer scorer;
  const ObstacleList list = list_of({seen(5.4, 0)}, 460 * kMillisecond);
  scorer.add(truth, {&list, 1});
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(1, 0, 0));
  EXPECT_NEAR(scorer.result().positive_warning.first.at(0), 5.4, 1e-6);
}

TEST(Scoring, ListsMeetTheNearestEntryWithin60Milliseconds) {
  Truth truth = standing({there(1, 5, 0)}, {1});
  truth.visible = {{0, {1}, {}}, {100 * kMillisecond, {}, {}}, {kSecond, {1}, {}}};
  std::vector<ObstacleList> lists;
  lists.push_back(list_of({}, 49 * kMillisecond));                      // of the first: one missed
  lists.push_back(list_of({seen(5, 0)}, 51 * kMillisecond));            // of the second: a ghost
  lists.push_back(list_of({seen(5, 0)}, 161 * kMillisecond));           // of none
  lists.push_back(list_of({seen(5, 0)}, kSecond - 60 * kMillisecond));  // of the third
  lists.push_back(list_of({seen(5, 0)}, kSecond));                      // of the third as well
  Scorer scorer;
  scorer.add(truth, lists);
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(2, 1, 1));
  EXPECT_EQ(scorer.result().lists_without_entry, 1U);
  EXPECT_EQ(scorer.result().covered, 3U);
  EXPECT_EQ(scorer.result().entries, 3U);
  EXPECT_TRUE(scorer.result().counts());
}

TEST(Scoring, OneListAndOneEntryBelongTogetherWhateverTheirTimes) {
  Truth truth = standing({there(1, 5, 0)}, {1});
  truth.visible[0].t_ns = 1598612520 * kSecond;
  EXPECT_THAT(counts(score(truth, {seen(5, 0)}).scores.all()), ElementsAre(1, 0, 0));
}

TEST(Scoring, TimesAtTheEndsOfTheirRangeAreNoTrouble) {
  Truth truth = standing({there(1, 5, 0)}, {1});
  truth.poses = {{INT64_MIN, Pose()}, {INT64_MAX, Pose()}};
  truth.visible = {{INT64_MIN, {1}, {}}, {INT64_MAX, {1}, {}}};
  std::vector<ObstacleList> lists;
  lists.push_back(list_of({seen(5, 0)}, INT64_MIN));
  lists.push_back(list_of({seen(5, 0)}, 0));
  lists.push_back(list_of({seen(5, 0)}, INT64_MAX));
  Scorer scorer;
  scorer.add(truth, lists);
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(2, 0, 0));
  EXPECT_EQ(scorer.result().lists_without_entry, 1U);
}

TEST(Scoring, AScoreWithoutCoverageDoesNotCount) {
  Truth truth = standing({}, {});
  truth.visible.clear();
  std::vector<ObstacleList> lists;
  for (int i = 0; i < 20; ++i) {
    truth.visible.push_back({i * 100 * kMillisecond, {}, {}});
    if (i != 7) lists.push_back(list_of({}, i * 100 * kMillisecond));
  }
  Scorer enough;
  enough.add(truth, lists);
  EXPECT_DOUBLE_EQ(enough.result().coverage(), 0.95);
  EXPECT_TRUE(enough.result().counts());
  Scorer too_few;
  too_few.add(truth, std::span(lists).first(18));
  EXPECT_FALSE(too_few.result().counts());
  // One run without coverage spoils the sum.
  too_few.add(truth, lists);
  EXPECT_FALSE(too_few.result().counts());
  EXPECT_EQ(too_few.result().runs_not_covered, 1U);
}

TEST(Scoring, BandsAreOfTheObstacleOrOfTheGhost) {
  const Truth truth = standing({there(1, 3, 0), there(2, 5, 0, kHole), there(3, 0, 7)}, {1, 2, 3});
  Obstacle ghost = seen(-11, 0);
  ghost.height = 0.2;
  const ScoringResult result = score(truth, {seen(3, 0), seen(5, 0.1, kRock), ghost});
  EXPECT_THAT(counts(result.by_range.at(1).positive), ElementsAre(1, 0, 0));
  EXPECT_THAT(counts(result.by_range.at(2).positive), ElementsAre(0, 1, 0));  // the wrong kind
  EXPECT_THAT(counts(result.by_range.at(2).negative), ElementsAre(0, 0, 1));
  EXPECT_THAT(counts(result.by_range.at(3).positive), ElementsAre(0, 0, 1));
  EXPECT_THAT(counts(result.by_range.at(5).positive), ElementsAre(0, 1, 0));
  EXPECT_THAT(counts(result.positive_sizes[1]), ElementsAre(0, 1, 0));
  EXPECT_THAT(counts(result.positive_sizes[2]), ElementsAre(1, 1, 1));
  EXPECT_THAT(counts(result.negative_sizes[2]), ElementsAre(0, 0, 1));
}

/// A robot that drives along x towards a rock at 10 m, a list each metre; `right` says in which of
/// them the rock is reported.
ScoringResult drive(const std::string& right, Pose odom = {}) {
  Truth truth = standing({there(1, 10, 0)}, {});
  truth.poses.clear();
  truth.visible.clear();
  std::vector<ObstacleList> lists;
  for (std::size_t i = 0; i < right.size(); ++i) {
    const auto t_ns = static_cast<std::int64_t>(i) * kSecond;
    Pose pose;
    pose.translation.x() = static_cast<double>(i);
    truth.poses.push_back({t_ns, pose});
    truth.visible.push_back({t_ns, {1}, {}});
    const Pose reported = odom * pose;
    std::vector<Obstacle> found;
    if (right[i] != '.') found.push_back(seen(10, 0, right[i] == '+' ? kRock : kHole));
    for (Obstacle& each : found) each.center = odom * each.center;
    lists.push_back(list_of(found, t_ns, reported));
  }
  Scorer scorer;
  scorer.add(truth, lists);
  return scorer.result();
}

TEST(Scoring, WarningDistanceIsThatOfTheFirstRightMatch) {
  const ScoringResult result = drive("..-+.+++");
  EXPECT_THAT(result.positive_warning.asked, ElementsAre(10));
  EXPECT_THAT(result.positive_warning.first, ElementsAre(7));
  EXPECT_THAT(result.positive_warning.stayed, ElementsAre(5));
  EXPECT_EQ(result.positive_warning.obstacles, 1U);
  EXPECT_EQ(result.negative_warning.obstacles, 0U);
  EXPECT_THAT(drive("..++.").positive_warning.stayed, ElementsAre());
  EXPECT_THAT(drive(".....").positive_warning.first, ElementsAre());
}

TEST(Scoring, PoseErrorForgivesWhereAndWhitherTheFirstPoseLooked) {
  Pose odom{{3, -2, 1}, from_roll_pitch_yaw(0, 0, 1)};
  const ScoringResult result = drive("+++++", odom);
  EXPECT_THAT(counts(result.scores.all()), ElementsAre(5, 0, 0));
  ASSERT_EQ(result.pose_errors.size(), 1U);
  EXPECT_NEAR(result.pose_errors[0].way, 4, 1e-9);
  EXPECT_NEAR(result.pose_errors[0].most, 0, 1e-9);
  EXPECT_NEAR(result.pose_errors[0].yaw, 0, 1e-9);
}

TEST(PoseError, GrowsWithScaleAndTurn) {
  std::vector<PosePair> poses;
  for (int i = 0; i <= 60; ++i) {
    Pose truth, reported;
    truth.translation.x() = i;
    reported.translation.x() = 0.99 * i;
    reported.rotation = from_roll_pitch_yaw(0, 0, radians(3.1 + i / 60.0));
    poses.push_back({i * kSecond, reported, truth});
  }
  // The first pose looks 3.1 degrees aside: laying it onto the truth turns the way.
  const PoseError error = pose_error(poses);
  EXPECT_NEAR(error.way, 60, 1e-9);
  EXPECT_NEAR(degrees(error.yaw_per_minute()), 1, 1e-9);
  EXPECT_NEAR(error.last,
              std::hypot(60 - 59.4 * std::cos(radians(3.1)), 59.4 * std::sin(radians(3.1))), 1e-9);
  EXPECT_EQ(error.last, error.most);
  EXPECT_NEAR(error.share(), error.last / 60, 1e-12);
}

TEST(PoseError, TellsTheMostFromTheLast) {
  // 30 m in 30 s; halfway 2 degrees and 0.9 m off, at the end 0.5 degrees and 0.3 m to the right.
  std::vector<PosePair> poses;
  const std::vector<std::pair<double, double>> off = {{0, 0}, {1, 0.4}, {2, 0.9}, {-0.5, -0.3}};
  for (std::size_t i = 0; i < off.size(); ++i) {
    const auto [yaw, aside] = off[i];
    Pose truth, reported;
    truth.translation.x() = 10.0 * static_cast<double>(i);
    reported.translation = {truth.translation.x(), aside, 0};
    reported.rotation = from_roll_pitch_yaw(0, 0, radians(yaw));
    poses.push_back({static_cast<std::int64_t>(i) * 10 * kSecond, reported, truth});
  }
  const PoseError error = pose_error(poses);
  EXPECT_NEAR(error.last, 0.3, 1e-9);
  EXPECT_NEAR(error.most, 0.9, 1e-9);
  EXPECT_NEAR(error.share(), 0.01, 1e-9);
  EXPECT_NEAR(error.most_share(), 0.03, 1e-9);
  EXPECT_NEAR(degrees(error.yaw), -0.5, 1e-9);
  EXPECT_NEAR(degrees(error.most_yaw), 2, 1e-9);
  EXPECT_NEAR(degrees(error.yaw_per_minute()), -1, 1e-9);
  EXPECT_NEAR(degrees(error.most_yaw_per_minute()), 4, 1e-9);
}

TEST(PoseError, OfASinglePoseOrNoneIsNothing) {
  for (const auto& poses : {std::vector<PosePair>{}, {PosePair{5, {}, {}}}}) {
    const PoseError error = pose_error(poses);
    EXPECT_EQ(error.most_share(), 0);
    EXPECT_EQ(error.yaw_per_minute(), 0);
    EXPECT_EQ(error.most_yaw_per_minute(), 0);
  }
}

TEST(Scoring, RunsAreSummedUp) {
  Scorer scorer;
  const Truth truth = standing({there(1, 5, 0)}, {1});
  const ObstacleList right = list_of({seen(5, 0)}), none = list_of({});
  scorer.add(truth, {&right, 1});
  scorer.add(truth, {&none, 1});
  EXPECT_THAT(counts(scorer.result().scores.all()), ElementsAre(1, 0, 1));
  EXPECT_EQ(scorer.result().runs, 2U);
  EXPECT_EQ(scorer.result().positive_warning.obstacles, 0U);  // of one entry: no drive
  scorer.add(truth, {});
  EXPECT_FALSE(scorer.result().counts());
}

TEST(Scoring, MedianOfNoneOddAndEven) {
  EXPECT_EQ(median({}), 0);
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

}  // namespace
}  // namespace scree
