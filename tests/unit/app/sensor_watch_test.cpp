#include "app/sensor_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class SensorWatchTest : public ::testing::Test {
protected:
  /// Looks every 50 ms while so many messages come and get lost each time; the log of the time.
  std::string run(std::int64_t milliseconds, std::uint64_t messages, std::uint64_t lost = 0) {
    return wait(milliseconds, [=, this] {
      status_.messages += messages;
      status_.lost += lost;
      if (messages > 0) status_.last_heard_ns = status_.last_message_ns = now_;
    });
  }
  /// And while as much comes that nobody understands.
  std::string run_with_noise(std::int64_t milliseconds) {
    return wait(milliseconds, [this] { status_.last_heard_ns = now_; });
  }
  std::string wait(std::int64_t milliseconds, const std::function<void()>& come) {
    std::string log;
    for (const std::int64_t end = now_ + milliseconds * kMillisecond; now_ < end;) {
      now_ += 50 * kMillisecond;
      come();
      log += look();
    }
    return log;
  }
  std::string look() {
    LogLines lines;
    has_changed_ = watch_.update(now_, status_, health_, lines);
    std::string log;
    for (const auto& line : lines) log += (line.is_warning ? "W " : "I ") + line.text + '\n';
    return log;
  }

  std::int64_t now_ = 7'000 * kMillisecond;
  SensorStatus status_;
  sensor_health_t health_{};
  SensorWatch watch_{{"things from X", "look at X"}, now_};
  bool has_changed_ = false;
};

TEST_F(SensorWatchTest, GoesThroughItsStatesWithALineEach) {
  EXPECT_EQ(run(950, 0), "");
  EXPECT_EQ(health_.state, sensor_health_t::NEVER_SEEN);
  EXPECT_EQ(run(2000, 0), "W no things from X have come yet: look at X\n");
  EXPECT_EQ(run(3000, 5), "I things from X come and are understood\n");
  EXPECT_EQ(health_.state, sensor_health_t::OK);
  EXPECT_NEAR(health_.rate, 100, 0.01);
  EXPECT_EQ(run(2000, 0), "W no things from X any more: look at X\n");
  EXPECT_EQ(health_.state, sensor_health_t::SILENT);
  EXPECT_EQ(health_.rate, 0);
  EXPECT_EQ(run(1000, 5), "I things from X again after 2.0 s\n");
  EXPECT_FALSE(has_changed_);
}

TEST_F(SensorWatchTest, WhatIsNotUnderstoodIsWrongData) {
  status_.refused = {{"size", "wrong size", 3}, {"sum", "wrong sum", 9}};
  const std::string log = run_with_noise(300);
  EXPECT_EQ(health_.state, sensor_health_t::WRONG_DATA);
  EXPECT_TRUE(has_changed_);
  EXPECT_THAT(log, HasSubstr("W things from X are not understood (wrong sum)"));
  EXPECT_THAT(log, HasSubstr("W things from X refused: wrong size (3 more, 3 since the start)"));
  EXPECT_THAT(health_.refused_reason, ElementsAre("size", "sum"));
  EXPECT_THAT(health_.refused, ElementsAre(3, 9));
  EXPECT_EQ(health_.reasons, 2);
  EXPECT_EQ(run(50, 1), "I things from X are understood\n");
}

TEST_F(SensorWatchTest, HalfAMessageAtTheBeginningIsNoWrongData) {
  EXPECT_EQ(run_with_noise(100), "");
  EXPECT_EQ(health_.state, sensor_health_t::NEVER_SEEN);
  EXPECT_EQ(run(50, 1), "I things from X come and are understood\n");
  run_with_noise(50);  // a cable that is pulled cuts a message in two
  run(1000, 0);
  EXPECT_EQ(run_with_noise(100), "");
  EXPECT_EQ(health_.state, sensor_health_t::SILENT);
  EXPECT_EQ(run(50, 1), "I things from X again after 1.1 s\n");
  run_with_noise(200);
  EXPECT_EQ(health_.state, sensor_health_t::OK);
  run_with_noise(100);
  EXPECT_EQ(health_.state, sensor_health_t::WRONG_DATA);
}

TEST_F(SensorWatchTest, IsSlowWhenATenthIsLostAndNotForLess) {
  run(3050, 95, 5);  // the first look begins the second
  EXPECT_EQ(health_.state, sensor_health_t::OK);
  EXPECT_NEAR(health_.rate, 1900, 0.01);
  EXPECT_NEAR(health_.expected_rate, 2000, 0.01);
  EXPECT_THAT(run(1000, 80, 20), HasSubstr("W only 1600 of 2000 things from X a second"));
  EXPECT_EQ(health_.state, sensor_health_t::SLOW);
  EXPECT_EQ(run(2000, 92, 8), "") << "it does not flicker";
  EXPECT_THAT(run(1000, 100), HasSubstr("I things from X as many as there should be again"));
  EXPECT_EQ(health_.state, sensor_health_t::OK);
}

TEST_F(SensorWatchTest, TheSecondInWhichItBeginsIsNotSlow) {
  watch_ = SensorWatch({"things from X", "look at X", 100}, now_);
  run(3000, 5);
  EXPECT_EQ(health_.state, sensor_health_t::OK);
  EXPECT_EQ(health_.expected_rate, 100);
  for (int i = 0; i < 5; ++i) {
    run(700, 0);
    run(700, 5);
    EXPECT_EQ(health_.state, sensor_health_t::OK);
  }
}

TEST_F(SensorWatchTest, TellsHowWellTheClockIsKnown) {
  status_.clock = {ClockState::pps_locked, -2'500'000'000, 40'000};
  look();
  EXPECT_EQ(health_.clock, sensor_health_t::PPS_LOCKED);
  EXPECT_DOUBLE_EQ(health_.clock_offset_s, -2.5);
  EXPECT_DOUBLE_EQ(health_.clock_accuracy_ms, 0.04);
}

}  // namespace
}  // namespace scree
