#include "app/health_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class HealthWatchTest : public ::testing::Test {
protected:
  HealthWatchTest() : watch_(settings(), now_) {}

  static Settings settings() {
    Settings settings;
    settings.lidar.sender = "192.168.1.201";
    return settings;
  }
  /// Lets time pass while the lidar does what `status_` says.
  std::string pass(std::int64_t milliseconds) {
    now_ += milliseconds * kMillisecond;
    return update();
  }
  /// The same with packets and lists coming all the time.
  std::string drive(std::int64_t milliseconds) {
    now_ += milliseconds * kMillisecond;
    datagram();
    packet();
    detector_ = {now_, now_};
    measure(milliseconds);
    return update();
  }
  void measure(std::int64_t milliseconds) {
    const auto samples = static_cast<std::uint64_t>(milliseconds / 10);
    imu_.imu.samples += samples;
    imu_.imu.useful += samples;
    imu_.last_bytes_ns = imu_.last_message_ns = now_;
    encoder_.encoder.accepted += samples;
    encoder_.last_frame_ns = encoder_.last_sample_ns = now_;
    encoder_.bus = encoder::BusState::active;
  }
  void datagram() {
    status_.sender = 0xC0A801C9;
    status_.datagram_size = 1206;
    ++status_.data_port.received;
    status_.last_datagram_ns = now_;
  }
  void packet() {
    ++status_.lidar.accepted;
    ++status_.lidar.by_mode[0];
    status_.last_packet_ns = now_;
    status_.last_sweep_ns = now_;
  }
  std::string update() {
    changed_ = watch_.update(now_, status_, imu_, encoder_, detector_, health_);
    std::string log;
    for (const auto& line : watch_.log()) log += (line.is_warning ? "W " : "I ") + line.text + '\n';
    return log;
  }

  std::int64_t now_ = 5'000 * kMillisecond;
  LidarStatus status_;
  ImuStatus imu_;
  EncoderStatus encoder_;
  DetectorStatus detector_{now_, 0};
  health_t health_{};
  HealthWatch watch_;
  bool changed_ = false;
};

TEST_F(HealthWatchTest, WithoutASenderItIsBlindAndSaysSoOnceAfterASecond) {
  EXPECT_THAT(pass(900), IsEmpty());
  EXPECT_EQ(health_.state, health_t::BLIND);
  EXPECT_EQ(health_.lidar.state, sensor_health_t::NEVER_SEEN);
  EXPECT_THAT(health_.reason, HasSubstr("nothing has come on UDP port 2368"));
  EXPECT_THAT(pass(100),
              AllOf(HasSubstr("W no packets on UDP port 2368 have come yet"), HasSubstr("cable")));
  EXPECT_THAT(pass(5000), IsEmpty());
  EXPECT_THAT(drive(50), AllOf(HasSubstr("first datagram"), Not(HasSubstr("again"))));
}

TEST_F(HealthWatchTest, PositionPacketsAloneAreNoMatterOfPowerOrCable) {
  status_.last_position_ns = now_ + 800 * kMillisecond;
  EXPECT_THAT(pass(1000),
              AllOf(HasSubstr("no packets on UDP port 2368 have come yet: its position"),
                    HasSubstr("power and cable are right"), Not(HasSubstr("check the sensor's"))));
  EXPECT_EQ(health_.reason, "nothing has come on UDP port 2368, but position packets come");
  drive(50);
  status_.last_position_ns = now_ + 900 * kMillisecond;
  EXPECT_THAT(pass(1000), HasSubstr("no packets on UDP port 2368 any more: its position packets"));
  EXPECT_EQ(health_.reason, "no packets on UDP port 2368, but position packets come");
  EXPECT_THAT(pass(1000), IsEmpty());
  EXPECT_EQ(health_.reason, "no packets on UDP port 2368");
}

TEST_F(HealthWatchTest, APulledCableEndsPositionPacketsTooAndIsNamed) {
  drive(50);
  status_.last_position_ns = now_;
  EXPECT_THAT(pass(300),
              AllOf(HasSubstr("no packets on UDP port 2368 any more: check the sensor's"),
                    Not(HasSubstr("are right"))));
  EXPECT_EQ(health_.reason, "no packets on UDP port 2368");
}

TEST_F(HealthWatchTest, OnlyOtherSendersIsSaid) {
  status_.data_port.foreign = 12;
  EXPECT_THAT(pass(100), HasSubstr("not from 192.168.1.201 (12 more"));
  EXPECT_THAT(health_.reason, HasSubstr("come from others than 192.168.1.201"));
}

TEST_F(HealthWatchTest, SeesOnceListsCome) {
  now_ += 10 * kMillisecond;
  datagram();
  packet();
  status_.last_sweep_ns = 0;
  EXPECT_THAT(update(), AllOf(HasSubstr("from 192.168.1.201 and has 1206 bytes"),
                              HasSubstr("vlp16, strongest return")));
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.lidar.state, sensor_health_t::OK);
  EXPECT_EQ(health_.state, health_t::BLIND);
  EXPECT_THAT(health_.reason, HasSubstr("not made a whole turn"));
  EXPECT_THAT(drive(50), HasSubstr("I sees"));
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.state, health_t::OK);
  EXPECT_EQ(health_.reason, "");
  EXPECT_THAT(drive(50), IsEmpty());
  EXPECT_FALSE(changed_);
}

TEST_F(HealthWatchTest, SilenceIsBlindWithin300Ms) {
  drive(50);
  const std::int64_t last = now_;
  std::string log;
  while (health_.state == health_t::OK) log = pass(50);
  EXPECT_LE(now_ - last, 300 * kMillisecond);
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.lidar.state, sensor_health_t::SILENT);
  EXPECT_THAT(log, AllOf(HasSubstr("W no packets on UDP port 2368 any more: check"),
                         HasSubstr("W blind: no packets on UDP port 2368")));
  EXPECT_THAT(pass(750), IsEmpty());
  EXPECT_THAT(pass(2000), IsEmpty());
  EXPECT_THAT(drive(50), AllOf(HasSubstr("again after 3.0 s"), HasSubstr("I sees")));
  EXPECT_EQ(health_.state, health_t::OK);
}

TEST_F(HealthWatchTest, DatagramsThatAreNotPacketsAreWrongData) {
  datagram();
  status_.lidar.refused[static_cast<std::size_t>(velodyne::Refusal::size)] = 3;
  EXPECT_THAT(pass(10), HasSubstr("refused: not 1206 bytes long (3 more"));
  for (int i = 0; i < 3; ++i) {
    datagram();
    pass(100);
  }
  EXPECT_EQ(health_.lidar.state, sensor_health_t::WRONG_DATA);
  EXPECT_THAT(health_.reason, HasSubstr("not 1206 bytes long"));
  EXPECT_THAT(health_.lidar.refused_reason, Contains("size"));
  EXPECT_THAT(health_.lidar.refused_reason, Not(Contains("none")));
  EXPECT_EQ(health_.lidar.reasons, static_cast<int>(health_.lidar.refused.size()));
}

TEST_F(HealthWatchTest, WhatProductByte0x21TurnsOutToBeIsSaidOnce) {
  drive(50);
  status_.firmware = velodyne::Firmware::early_vlp16;
  EXPECT_THAT(drive(50), HasSubstr(std::string(sentence(velodyne::Firmware::early_vlp16))));
  EXPECT_THAT(drive(50), IsEmpty());
}

TEST_F(HealthWatchTest, PulsesAndTheirLossAreSaidOnce) {
  drive(50);
  status_.pulses = 1;
  EXPECT_THAT(drive(50), HasSubstr("I the pulse per second of gpio.pps comes"));
  status_.pulses = 2;
  EXPECT_THAT(drive(50), IsEmpty());
  status_.is_pps_lost = true;
  EXPECT_THAT(drive(50), HasSubstr("W the GPIO chip of gpio.pps is gone"));
  EXPECT_THAT(drive(50), IsEmpty());
  status_.is_pps_lost = false;
  EXPECT_THAT(drive(50), HasSubstr("I the line of gpio.pps is there again"));
  status_.has_no_pulse = true;
  EXPECT_THAT(drive(50), HasSubstr("W the lidar says that it hears no pulse per second"));
  EXPECT_THAT(drive(50), IsEmpty());
}

TEST_F(HealthWatchTest, AnImuWithoutOrientationAndRateIsNoUse) {
  std::string log;
  for (int i = 0; i < 10; ++i) {
    imu_.imu.samples += 5;
    imu_.last_bytes_ns = now_;
    log += pass(50);
  }
  EXPECT_EQ(health_.imu.state, sensor_health_t::WRONG_DATA);
  EXPECT_THAT(log, HasSubstr("are not understood (neither orientation nor rate of turn in them)"));
}

TEST_F(HealthWatchTest, MessagesOfHighRateAreNotRefused) {
  Settings high_rate = settings();
  high_rate.imu.gyro_hr_rate = 1000;
  watch_ = HealthWatch(high_rate, now_);
  std::string log;
  for (int i = 0; i < 41; ++i) {
    imu_.imu.samples += 50;
    log += drive(50);
  }
  EXPECT_EQ(health_.imu.state, sensor_health_t::OK);
  EXPECT_NEAR(health_.imu.rate, 100, 1);
  EXPECT_THAT(log, Not(HasSubstr("orientation")));
}

TEST_F(HealthWatchTest, SweepsThatWaitedInVainAreSaid) {
  drive(50);
  detector_.not_covered = 3;
  EXPECT_THAT(pass(20), HasSubstr("W sweeps went on without the samples of IMU or encoder"));
}

TEST_F(HealthWatchTest, MessagesThatLcmDoesNotTakeAreSaid) {
  drive(50);
  detector_.not_sent = 3;
  EXPECT_THAT(pass(20), HasSubstr("W messages that LCM did not take"));
}

TEST_F(HealthWatchTest, MotionThatIsNotBelievedIsSaid) {
  drive(50);
  detector_.slips = 2;
  EXPECT_THAT(pass(20), HasSubstr("W sweeps during which the wheel slipped"));
  detector_.heading_resets = 1;
  EXPECT_THAT(pass(20), HasSubstr("W turns of the IMU's yaw"));
}

TEST_F(HealthWatchTest, WithoutImuAndEncoderItSeesAndSaysThatTheyAreSilent) {
  drive(50);
  EXPECT_EQ(health_.imu.state, sensor_health_t::OK);
  EXPECT_EQ(health_.encoder.state, sensor_health_t::OK);
  EXPECT_EQ(health_.imu.source, "/dev/ttyUSB0");
  EXPECT_EQ(health_.encoder.source, "can0");
  EXPECT_EQ(health_.encoder_bus, "active");
  const std::int64_t last = now_;
  std::string log;
  while (health_.imu.state == sensor_health_t::OK) {
    now_ += 50 * kMillisecond;
    datagram();
    packet();
    detector_ = {now_, now_};
    log = update();
  }
  EXPECT_LE(now_ - last, 300 * kMillisecond);
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.imu.state, sensor_health_t::SILENT);
  EXPECT_EQ(health_.encoder.state, sensor_health_t::SILENT);
  EXPECT_EQ(health_.state, health_t::OK);
  EXPECT_THAT(log, AllOf(HasSubstr("W no messages from the IMU on /dev/ttyUSB0 any more: check"),
                         HasSubstr("W no frames of the encoder on can0 any more: check")));
  EXPECT_THAT(drive(50), AllOf(HasSubstr("I messages from the IMU on /dev/ttyUSB0 again"),
                               HasSubstr("I frames of the encoder on can0 again")));
}

TEST_F(HealthWatchTest, ALostBusIsAChange) {
  drive(50);
  drive(50);
  EXPECT_FALSE(changed_);
  encoder_.bus = encoder::BusState::bus_off;
  pass(50);
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.encoder_bus, "bus_off");
}

TEST_F(HealthWatchTest, AnImuBelowItsConfiguredRateIsSlow) {
  for (int i = 0; i < 21; ++i) drive(50);
  EXPECT_EQ(health_.imu.state, sensor_health_t::OK);
  EXPECT_NEAR(health_.imu.rate, 100, 1);
  EXPECT_EQ(health_.imu.expected_rate, 100);
  for (int i = 0; i < 21; ++i) {
    drive(50);
    --imu_.imu.useful;
  }
  EXPECT_EQ(health_.imu.state, sensor_health_t::SLOW);
  EXPECT_EQ(health_.state, health_t::OK);
}

TEST_F(HealthWatchTest, RefusalsAreSaidAtMostEveryTenSeconds) {
  auto& refused = status_.lidar.refused[static_cast<std::size_t>(velodyne::Refusal::flags)];
  drive(50);
  refused = 1;
  EXPECT_THAT(drive(50), HasSubstr("FF EE (1 more, 1 since the start)"));
  refused = 900;
  EXPECT_THAT(drive(9000), IsEmpty());
  EXPECT_THAT(drive(2000), HasSubstr("FF EE (899 more, 900 since the start)"));
}

TEST_F(HealthWatchTest, ADetectorThatIsLateAgainAndAgainIsSaidEveryTenSeconds) {
  EXPECT_THAT(drive(50), HasSubstr("I sees"));
  const auto be_late = [&] {
    now_ += 300 * kMillisecond;
    datagram();
    packet();
    measure(300);
    return update();
  };
  EXPECT_THAT(be_late(), HasSubstr("W blind: the detector is late"));
  EXPECT_THAT(drive(50), HasSubstr("I sees"));
  for (int i = 0; i < 20; ++i) {
    EXPECT_THAT(be_late(), IsEmpty());
    EXPECT_EQ(health_.state, health_t::BLIND);
    EXPECT_THAT(drive(50), IsEmpty());
    EXPECT_EQ(health_.state, health_t::OK);
  }
  drive(5000);
  EXPECT_THAT(be_late(), HasSubstr("W blind: the detector is late"));
}

TEST_F(HealthWatchTest, AnotherReasonAndAnotherStateOfAClockAreChanges) {
  drive(50);
  status_.clock.state = ClockState::pps_locked;
  drive(50);
  EXPECT_TRUE(changed_);
  pass(1000);
  EXPECT_EQ(health_.state, health_t::BLIND);
  datagram();
  pass(SensorWatch::kSilence / kMillisecond);
  datagram();
  pass(10);
  EXPECT_EQ(health_.state, health_t::BLIND);
  EXPECT_TRUE(changed_);
}

TEST_F(HealthWatchTest, NamesASettingThatTheSensorsContradict) {
  drive(100);
  ASSERT_EQ(health_.state, health_t::OK);
  SetupReport wrong;
  wrong.count = 1;
  wrong.findings[0] = {.fault = SetupFault::encoder_place, .off = 0.3, .set = {0, 0.3, 0}};
  const auto with = [this](const SetupReport& setup) {
    now_ += 100 * kMillisecond;
    packet();
    detector_ = {now_, now_, 0, 0, 0, 0, setup};
    return update();
  };
  EXPECT_THAT(with(wrong), HasSubstr("W encoder.translation looks 0.30 m"));
  EXPECT_TRUE(changed_);
  EXPECT_EQ(health_.state, health_t::OK);
  EXPECT_THAT(health_.setup, Contains(HasSubstr("encoder.translation")));
  EXPECT_THAT(with(wrong), Not(HasSubstr("encoder.translation")));
  EXPECT_THAT(with({}), Not(HasSubstr("encoder.translation")));
  EXPECT_THAT(health_.setup, IsEmpty());
}

TEST_F(HealthWatchTest, SaysHowManyTurnsADetectorThatIsTooSlowKeepsUpWith) {
  std::string log;
  const auto turn = [&](bool is_left_out) {
    ++status_.lidar.sweeps;
    if (is_left_out) ++status_.sweeps_dropped;
    log += drive(100);
  };
  for (int i = 0; i < 150; ++i) turn(i == 70);
  EXPECT_THAT(health_.setup, IsEmpty());
  for (int i = 0; i < 120; ++i) turn(i % 4 != 0);
  EXPECT_EQ(health_.state, health_t::OK);
  EXPECT_THAT(health_.setup, Contains(HasSubstr("keeps up with 2.6 of 10.0 turns a second")));
  EXPECT_THAT(log, HasSubstr("W the detector keeps up with"));
  for (int i = 0; i < 120; ++i) turn(false);
  EXPECT_THAT(health_.setup, IsEmpty());
}

TEST_F(HealthWatchTest, IsBlindWhereASettingSpoilsTheLists) {
  drive(100);
  SetupReport wrong;
  wrong.count = 1;
  wrong.findings[0] = {
      .fault = SetupFault::encoder_scale, .is_grave = true, .off = 2, .set = {0.0001, 0, 0}};
  now_ += 100 * kMillisecond;
  packet();
  detector_ = {now_, now_, 0, 0, 0, 0, wrong};
  EXPECT_THAT(update(), HasSubstr("W blind: encoder.scale looks 2.0 times too large: set 0.0001"));
  EXPECT_EQ(health_.state, health_t::BLIND);
}

TEST_F(HealthWatchTest, DoesNotMissASensorThatIsSwitchedOff) {
  Settings without = settings();
  without.imu.device.clear();
  without.encoder.interface.clear();
  watch_ = HealthWatch(without, now_);
  std::string log;
  for (int i = 0; i < 100; ++i) {
    now_ += 100 * kMillisecond;
    datagram();
    packet();
    detector_ = {now_, now_};
    log += update();
  }
  EXPECT_THAT(log, Not(HasSubstr("IMU")));
  EXPECT_THAT(log, Not(HasSubstr("encoder")));
}

}  // namespace
}  // namespace scree
