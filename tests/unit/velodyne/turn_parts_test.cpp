#include <gtest/gtest.h>

#include <vector>

#include "turning_sensor.hpp"

namespace scree::velodyne {
namespace {

std::vector<Seen> ends_of(const std::vector<Seen>& seen) {
  std::vector<Seen> ends;
  for (const Seen& each : seen) {
    if (each.ends_turn) ends.push_back(each);
  }
  return ends;
}

TEST(TurnParts, WhatThereIsOfATurnIsHandedOutAtTheEndOfEachPart) {
  for (const int parts : {2, 4, 8}) {
    for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
      LidarSettings settings;
      settings.cut_azimuth_deg = 90;
      TurningSensor sensor(settings, parts);
      sensor.mode = mode;
      sensor.send_for(1.0);
      SCOPED_TRACE(testing::Message() << parts << " parts");
      EXPECT_EQ(sensor.counters().sweeps, ends_of(sensor.seen).size());
      EXPECT_EQ(sensor.counters().parts, sensor.seen.size() - ends_of(sensor.seen).size());
      int part = 0;
      for (std::size_t i = 1; i < sensor.seen.size(); ++i) {
        const Seen &before = sensor.seen[i - 1], &each = sensor.seen[i];
        if (before.turn == 0 && !before.ends_turn)
          continue;  // the rest of the turn that was under way
        part = before.ends_turn ? 1 : part + 1;
        EXPECT_EQ(each.turn, before.turn + (before.ends_turn ? 1 : 0));
        EXPECT_EQ(each.ends_turn, part == parts);
        EXPECT_TRUE(each.is_whole);
        EXPECT_NEAR(static_cast<double>(each.end_ns - each.begin_ns), 1e8 * part / parts, 2e5);
        EXPECT_NEAR(static_cast<double>(each.points), 16 / 55.296e-5 * part / parts, 40);
        if (before.ends_turn) continue;
        EXPECT_NEAR(static_cast<double>(each.begin_ns), static_cast<double>(before.begin_ns), 1e5);
      }
    }
  }
}

TEST(TurnParts, TheEndsOfTurnsStayAsTheyAre) {
  TurningSensor whole, parted({}, 8);
  whole.send_for(1.0);
  parted.send_for(1.0);
  const std::vector<Seen> ends = ends_of(parted.seen);
  ASSERT_EQ(ends.size(), whole.seen.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_EQ(ends[i].begin_ns, whole.seen[i].begin_ns);
    EXPECT_EQ(ends[i].end_ns, whole.seen[i].end_ns);
    EXPECT_EQ(ends[i].points, whole.seen[i].points);
    EXPECT_EQ(ends[i].packets, whole.seen[i].packets);
    EXPECT_EQ(ends[i].is_whole, whole.seen[i].is_whole);
  }
}

TEST(TurnParts, OfTheTurnThatWasUnderWayNoPartIsWhole) {
  TurningSensor sensor({}, 8);
  for (int i = 0; i < 20; ++i) sensor.skip();
  sensor.send_for(0.06);
  ASSERT_GE(sensor.seen.size(), 3U);
  for (const Seen& each : sensor.seen) {
    EXPECT_FALSE(each.ends_turn);
    EXPECT_FALSE(each.is_whole);
  }
}

TEST(TurnParts, AWaveringAzimuthAtTheCutEndsNoPart) {
  TurningSensor sensor({}, 8);
  sensor.send_wavering_at_zero(400);
  EXPECT_EQ(sensor.counters().parts, 0U);
}

TEST(TurnParts, ASensorThatStandsStillHasNone) {
  TurningSensor sensor({}, 8);
  sensor.turns_per_second = 0;
  sensor.send_for(2.0);
  EXPECT_EQ(sensor.counters().parts, 0U);
}

}  // namespace
}  // namespace scree::velodyne
