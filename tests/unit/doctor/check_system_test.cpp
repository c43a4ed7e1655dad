#include "doctor/check_system.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/timex.h>

#include "doctor/proc_text.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Verdict = Finding::Verdict;

constexpr std::string_view kServiceLimits =
    "Max locked memory         8388608              8388608              bytes     \n"
    "Max realtime priority     40                   40                             \n";

TEST(Rights, AreTheLimitsOrTheCapabilities) {
  Rights rights = rights_of(kServiceLimits, "CapEff:\t0000000000000000\n");
  EXPECT_EQ(rights.priority, 40U);
  EXPECT_EQ(rights.locked_bytes, 8388608U);
  rights = rights_of(kServiceLimits, "CapEff:\t000001ffffffffff\n");
  EXPECT_EQ(rights.priority, kUnlimited);
  EXPECT_EQ(rights.locked_bytes, kUnlimited);
}

TEST(Rights, AreCheckedByWhatRunsElseByWhatMay) {
  const Running none;
  EXPECT_EQ(check_priority(none, {40, 0}).verdict, Verdict::ok);
  EXPECT_THAT(check_priority(none, {0, 0}).text, HasSubstr("rtprio 40"));
  EXPECT_EQ(check_memory(none, {0, kUnlimited}).verdict, Verdict::ok);
  EXPECT_THAT(check_memory(none, {0, 8 << 20}).text, HasSubstr("only 8 MB"));

  const Rights all{99, kUnlimited};
  EXPECT_EQ(check_priority({true, true, 0}, {}).verdict, Verdict::ok);
  EXPECT_EQ(check_priority({true, false, 0}, all).verdict, Verdict::wrong);
  EXPECT_THAT(check_memory({true, false, 204800}, {}).text, HasSubstr("200 MB"));
  EXPECT_EQ(check_memory({true, true, 0}, all).verdict, Verdict::wrong);
}

TEST(Clock, MustBeSetByOthers) {
  EXPECT_THAT(check_clock(TIME_ERROR, 16'000'000).text, HasSubstr("chrony"));
  const Finding good = check_clock(TIME_OK, 1500);
  EXPECT_EQ(good.verdict, Verdict::ok);
  EXPECT_THAT(good.text, HasSubstr("1.5 ms"));
}

TEST(Serial, IsChecked) {
  SerialFacts facts;
  const auto text = [&] { return check_serial("/dev/imu", facts).text; };
  EXPECT_THAT(text(), HasSubstr("there is no /dev/imu"));
  facts.exists = true;
  EXPECT_THAT(text(), HasSubstr("no serial port"));
  facts.is_terminal = true;
  facts.group = "dialout";
  EXPECT_THAT(text(), HasSubstr("usermod -aG dialout"));
  facts.may_use = true;
  facts.latency_timer = 16;
  facts.timer_file = "/sys/class/tty/ttyUSB0/device/latency_timer";
  EXPECT_THAT(text(), AllOf(HasSubstr("every 16 ms"), HasSubstr("echo 1 > " + facts.timer_file)));
  facts.latency_timer = 1;
  EXPECT_EQ(check_serial("/dev/imu", facts).verdict, Verdict::ok);
  facts.latency_timer.reset();
  EXPECT_EQ(check_serial("/dev/imu", facts).verdict, Verdict::ok);
}

TEST(Sensor, IsCheckedByItsHealth) {
  sensor_health_t health{};
  health.source = "192.168.1.201";
  const auto text = [&] { return check_sensor("lidar", health, "look there").text; };
  health.state = sensor_health_t::OK;
  health.rate = 754;
  EXPECT_EQ(check_sensor("lidar", health, "").verdict, Verdict::ok);
  EXPECT_THAT(text(), HasSubstr("754 messages a second from 192.168.1.201"));
  health.state = sensor_health_t::SLOW;
  health.expected_rate = 1000;
  EXPECT_THAT(text(), HasSubstr("only 754 of 1000 messages a second"));
  health.state = sensor_health_t::WRONG_DATA;
  EXPECT_THAT(text(), HasSubstr("of another kind"));
  health.refused_reason = {"size", "mode"};
  health.refused = {3, 7};
  EXPECT_THAT(text(), HasSubstr("(mode)"));
  health.state = sensor_health_t::SILENT;
  EXPECT_THAT(text(), AllOf(HasSubstr("any more"), HasSubstr("look there")));
  health.state = sensor_health_t::NEVER_SEEN;
  EXPECT_THAT(text(), HasSubstr("nothing has come"));
}

}  // namespace
}  // namespace scree
