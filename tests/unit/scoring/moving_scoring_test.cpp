#include <gtest/gtest.h>

#include "scoring/scoring.hpp"

namespace scree {
namespace {

constexpr std::int64_t kTurnNs = 100'000'000;

Outline square(double x, double y) {
  return {{x - 0.3, y - 0.3}, {x + 0.3, y - 0.3}, {x + 0.3, y + 0.3}, {x - 0.3, y + 0.3}};
}

/// Someone walks along y = 0 at 1 m/s, past a rock at (0, 4); 30 sweeps.
Truth walk() {
  Truth truth;
  TrueObstacle walker;
  walker.id = 1;
  walker.center = {3, 0, 1};
  walker.footprint = square(3, 0);
  walker.track = {{0, {3, 0}, 0}, {30 * kTurnNs, {6, 0}, 0}};
  TrueObstacle rock;
  rock.id = 2;
  rock.center = {0, 4, 0};
  rock.footprint = square(0, 4);
  truth.obstacles = {walker, rock};
  truth.poses = {{0, Pose()}};
  for (int i = 0; i < 30; ++i) truth.visible.push_back({i * kTurnNs, {1, 2}, {}});
  return truth;
}

Obstacle reported(double x, double y, double speed = 0) {
  Obstacle obstacle;
  obstacle.center = {x, y, 0.5};
  obstacle.extent = {0.4, 0.4, 1};
  obstacle.height = 1;
  obstacle.velocity = {speed, 0};
  return obstacle;
}

ScoringResult score_walk(const std::function<void(int, FixedVector<Obstacle>&)>& fill) {
  const Truth truth = walk();
  std::vector<ObstacleList> lists;
  for (int i = 0; i < 30; ++i) {
    ObstacleList list(4);
    list.stamp_ns = i * kTurnNs;
    fill(i, list.obstacles);
    lists.push_back(std::move(list));
  }
  Scorer scorer;
  scorer.add(truth, lists);
  return scorer.result();
}

TEST(MovingScoring, WhoIsFollowedIsFoundWhereItIsAtThatTime) {
  const ScoringResult result = score_walk([](int i, FixedVector<Obstacle>& list) {
    list.push_back(reported(0, 4));
    if (i >= 3) list.push_back(reported(3 + 0.1 * i, 0, 1.2));
  });
  EXPECT_EQ(result.moving.asked, 30U);
  EXPECT_EQ(result.moving.found, 27U);
  ASSERT_EQ(result.moving.delays.size(), 1U);
  EXPECT_NEAR(result.moving.delays[0], 0.3, 1e-9);
  EXPECT_EQ(result.moving.velocity_errors.size(), 22U) << "half a second after the first match";
  EXPECT_NEAR(median(result.moving.velocity_errors), 0.2, 1e-6);
  EXPECT_EQ(result.moving.ghosts, 0U);
  EXPECT_EQ(result.standing.all().f1(), 1);
  EXPECT_EQ(result.scores.all().true_positives, 57U);
  EXPECT_EQ(result.positive_warning.obstacles, 1U) << "of what stands";
}

TEST(MovingScoring, WhatStaysBehindIsAGhost) {
  const ScoringResult result = score_walk([](int i, FixedVector<Obstacle>& list) {
    list.push_back(reported(3 + 0.1 * i, 0, 1));
    if (i >= 20) list.push_back(reported(3.2, 0));
    if (i == 25) list.push_back(reported(-5, -5, 2));
    if (i == 26) list.push_back(reported(-5, -5));
  });
  EXPECT_EQ(result.moving.ghosts, 11U) << "what moves where nothing is, too";
  EXPECT_EQ(result.moving.lists_with_ghosts, 10U);
  EXPECT_EQ(result.standing.positive.false_positives, 12U);
  EXPECT_EQ(result.standing.positive.false_negatives, 30U);
}

TEST(MovingScoring, WithoutTracksNothingIsCountedApart) {
  Truth truth = walk();
  truth.obstacles[0].track.clear();
  ObstacleList list(1);
  Scorer scorer;
  scorer.add(truth, {&list, 1});
  EXPECT_EQ(scorer.result().moving.lists, 0U);
}

}  // namespace
}  // namespace scree
