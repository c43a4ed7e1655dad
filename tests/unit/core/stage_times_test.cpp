#include "scree/core/stage_times.hpp"

#include <gtest/gtest.h>

namespace scree {
namespace {

std::int64_t now_ns = 0;

std::int64_t time_of(const StageTimer& timer, Stage stage) {
  return timer.times()[static_cast<std::size_t>(stage)];
}

TEST(StageTimer, TakesTheTimeOfEachStageOfTheLastList) {
  StageTimer timer([] { return now_ns; });
  now_ns = 1000;
  timer.start();
  now_ns += 7;
  timer.done(Stage::motion);
  now_ns += 30;
  timer.done(Stage::network);
  EXPECT_EQ(time_of(timer, Stage::motion), 7);
  EXPECT_EQ(time_of(timer, Stage::network), 30);
  EXPECT_EQ(time_of(timer, Stage::map), kDidNotRun);
  now_ns += 500;
  timer.start();
  now_ns += 2;
  timer.done(Stage::map);
  EXPECT_EQ(time_of(timer, Stage::map), 2);
  EXPECT_EQ(time_of(timer, Stage::motion), kDidNotRun);
}

TEST(StageTimer, WithoutAClockNothingRan) {
  StageTimer timer;
  timer.start();
  timer.done(Stage::motion);
  EXPECT_EQ(time_of(timer, Stage::motion), kDidNotRun);
}

}  // namespace
}  // namespace scree
