#include "scree/detect/overlaps.hpp"

#include <gtest/gtest.h>

#include "detect/boxes.hpp"

namespace scree {
namespace {

TEST(ResolveOverlaps, AHoleWithinARockIsNone) {
  constexpr auto kHole = ObstacleKind::negative;
  const Obstacle rock = box(3, 1, 1, 0.8, 50), within = box(3.4, 1.3, 2, 1, 900, kHole),
                 beside = box(3.6, 1, 0.6, 0.3, 40, kHole), inner = box(3.1, 1, 0.3, 0.2, 9);
  FixedVector<Obstacle> list(8);
  for (const Obstacle& obstacle : {within, rock, beside, inner}) list.push_back(obstacle);
  resolve_overlaps(list);
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].id, rock.id);
  EXPECT_EQ(list[1].id, beside.id) << "its middle lies on free ground";
  EXPECT_EQ(list[2].id, inner.id) << "a rock in a rock";
}

TEST(ResolveOverlaps, ARockAroundASurerHoleIsItsRim) {
  Obstacle rim = box(3, 1, 1.8, 0.8, 50), far = box(8, 1, 1, 0.8, 50);
  const Obstacle hole = box(3.4, 1.3, 2, 1, 900, ObstacleKind::negative);
  rim.confidence = far.confidence = 0.8F;
  FixedVector<Obstacle> list(8);
  for (const Obstacle& obstacle : {rim, hole, far}) list.push_back(obstacle);
  resolve_overlaps(list);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].id, hole.id);
  EXPECT_EQ(list[1].id, far.id);
}

TEST(ResolveOverlaps, ALongStepStaysBesideASurerHole) {
  Obstacle step = box(3, 1, 9, 2, 50);
  const Obstacle hole = box(3.4, 1.3, 1, 0.5, 900, ObstacleKind::negative);
  step.confidence = 0.8F;
  FixedVector<Obstacle> list(8);
  for (const Obstacle& obstacle : {step, hole}) list.push_back(obstacle);
  resolve_overlaps(list);
  EXPECT_EQ(list.size(), 2U);
}

}  // namespace
}  // namespace scree
