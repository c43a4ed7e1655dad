#include "app/output_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr StopSettings kZone{.length = 2, .width = 1, .hold = 0.5};

/// A line that remembers what it was set to, without repetitions. A chip that is plugged in again
/// has forgotten it.
struct Line {
  std::vector<bool> levels;
  int tries = 0;
  bool is_gone = false;

  RobotLines::Set setter() {
    return [this](bool is_on) {
      ++tries;
      if (!is_gone && (levels.empty() || levels.back() != is_on)) levels.push_back(is_on);
      return !is_gone;
    };
  }
  void plug_in_again() {
    is_gone = false;
    levels.clear();
  }
};

ObstacleList list_with_rock_at(double x) {
  ObstacleList list(1);
  Obstacle rock;
  rock.center = {x, 0, 0.2};
  rock.extent = {0.2, 0.2, 0.4};
  list.obstacles.push_back(rock);
  return list;
}

TEST(OutputLines, StopsForBlindnessAndForAnObstacleAtOnceAndHoldsBoth) {
  Line stop;
  OutputLines lines(kZone, {stop.setter(), {}, {}});
  EXPECT_TRUE(lines.is_stopped(0));
  lines.set_blind(true, 0);
  lines.set_blind(false, 10 * kMillisecond);
  lines.update(list_with_rock_at(9), 500 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true));
  lines.set_blind(false, 510 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true, false));
  lines.update(list_with_rock_at(1), 600 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true, false, true)) << "without waiting for a look";
  lines.update(list_with_rock_at(9), 700 * kMillisecond);
  lines.set_blind(false, 1199 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true, false, true));
  lines.set_blind(false, 1200 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true, false, true, false));
  lines.set_blind(true, 1300 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true, false, true, false, true));
}

TEST(OutputLines, HeartbeatChangesWithEachBeat) {
  Line heartbeat;
  OutputLines lines(kZone, {{}, heartbeat.setter(), {}});
  for (int i = 0; i < 4; ++i) lines.toggle_heartbeat();
  EXPECT_THAT(heartbeat.levels, ElementsAre(true, false, true, false));
}

TEST(OutputLines, ALineThatCannotBeSetIsSaidAndTriedUntilItCan) {
  Line stop, heartbeat;
  OutputLines lines(kZone, {stop.setter(), heartbeat.setter(), {}});
  lines.set_blind(true, 0);
  EXPECT_EQ(lines.problem(), "");
  heartbeat.is_gone = true;
  lines.toggle_heartbeat();
  EXPECT_THAT(lines.problem(), HasSubstr("the heartbeat line cannot be set"));
  stop.is_gone = true;
  for (int i = 1; i <= 4; ++i) lines.set_blind(true, i * 100 * kMillisecond);
  EXPECT_THAT(lines.problem(), HasSubstr("the stop line cannot be set"));
  EXPECT_EQ(stop.tries, 5);
  stop.plug_in_again();
  heartbeat.is_gone = false;
  lines.set_blind(true, 900 * kMillisecond);
  lines.toggle_heartbeat();
  EXPECT_EQ(lines.problem(), "");
  EXPECT_THAT(stop.levels, ElementsAre(true));
}

TEST(OutputLines, AChipThatWasUnpluggedForAMomentGetsItsLevelAgain) {
  Line stop;
  OutputLines lines(kZone, {stop.setter(), {}, {}});
  lines.set_blind(true, 0);
  stop.plug_in_again();
  lines.set_blind(true, 20 * kMillisecond);
  EXPECT_THAT(stop.levels, ElementsAre(true));
}

TEST(OutputLines, WithoutLinesTheDecisionIsStillMade) {
  OutputLines lines(kZone, {});
  lines.set_blind(false, 0);
  lines.update(list_with_rock_at(9), 0);
  lines.toggle_heartbeat();
  EXPECT_FALSE(lines.is_stopped(501 * kMillisecond));
  EXPECT_EQ(lines.problem(), "");
}

}  // namespace
}  // namespace scree
