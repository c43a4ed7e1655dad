#include "scree/drivers/xsens/start_up.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "scree/core/nanoseconds.hpp"
#include "unit/xsens/emulated_mti.hpp"

namespace scree::xsens {
namespace {

using test::ByteVector;
using test::EmulatedMti;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using State = StartUp::State;

/// Runs a start against a device, with time that passes only when nothing else happens. The device
/// measures all the while that it may.
class Attempt {
public:
  explicit Attempt(const ImuSettings& settings) : start(settings) {}

  void operator()(EmulatedMti& device) {
    start.begin(now_ns);
    for (int i = 0; i < 500 && start.state() == State::working; ++i) {
      const Bytes output = start.take_output();
      const ByteVector sent(output.begin(), output.end());
      ByteVector answer;
      if (!sent.empty()) answer = device.answer(sent, start.baud());
      const ByteVector sample = device.sample();
      if (device.baud == start.baud()) {
        // Data are on the line when the answer comes.
        answer.insert(answer.begin(), sample.begin(), sample.end());
      } else {
        answer = {0xFA, 0x00, 0xFF, 0x80};  // what the wrong bit rate makes of it
      }
      start.take(answer, now_ns);
      if (sent.empty()) {
        now_ns = std::max(now_ns, start.due_ns());
        start.advance(now_ns);
      }
    }
  }
  double seconds() const { return static_cast<double>(now_ns) * 1e-9; }

  std::int64_t now_ns = 0;
  StartUp start;
};

TEST(StartUp, ConfiguresWhatIsAskedFor) {
  EmulatedMti device;
  ImuSettings settings;
  settings.rate = 400;
  settings.gyro_hr_rate = 1000;
  settings.baud = device.baud = 2'000'000;
  device.highest_rate = 1000;
  Attempt run(settings);
  run(device);
  ASSERT_EQ(run.start.state(), State::measuring) << run.start.problem();
  EXPECT_THAT(device.heard, ElementsAre(0x30, 0x00, 0xC0, 0x10));
  EXPECT_TRUE(device.is_measuring);
  // Data ids and rates as MT0101P lists them; 0xFFFF is "with every message".
  EXPECT_THAT(device.outputs,
              ElementsAre(0x10, 0x20, 0xFF, 0xFF, 0x10, 0x60, 0xFF, 0xFF, 0x20, 0x10, 0x01, 0x90,
                          0x40, 0x20, 0x01, 0x90, 0x80, 0x20, 0x01, 0x90, 0xE0, 0x20, 0xFF, 0xFF,
                          0x80, 0x40, 0x03, 0xE8));
  EXPECT_EQ(run.start.device_id(), 0x07712345U);
  EXPECT_EQ(run.start.note(), "");
  EXPECT_EQ(run.seconds(), 0);
}

TEST(StartUp, FindsTheDeviceAtAnotherBitRateAndSetsIt) {
  for (const int found_at : {115200, 460800, 9600, 2000000}) {
    EmulatedMti device;
    device.baud = found_at;
    Attempt run(ImuSettings{});
    run(device);
    ASSERT_EQ(run.start.state(), State::measuring) << run.start.problem();
    EXPECT_EQ(device.baud, 921600);
    EXPECT_EQ(run.start.baud(), 921600);
    EXPECT_EQ(device.bauds_heard.front(), 921600) << "the configured one is tried first";
    EXPECT_THAT(device.heard, ElementsAre(0x30, 0x00, 0x18, 0x40, 0x30, 0xC0, 0x10));
    EXPECT_LT(run.seconds(), 10);
  }
}

TEST(StartUp, ALostAnswerIsAskedForAgain) {
  for (const int id : {0x30, 0x00, 0x18, 0x40, 0xC0, 0x10}) {
    EmulatedMti device;
    device.baud = 115200;
    device.ignores[id] = 1;
    Attempt run(ImuSettings{});
    run(device);
    if (id == 0x40) {
      // A device that was not reset stays at its old bit rate.
      EXPECT_EQ(run.start.state(), State::failed);
      EXPECT_THAT(run.start.problem(), HasSubstr("GoToConfig"));
      continue;
    }
    EXPECT_EQ(run.start.state(), State::measuring) << id << ": " << run.start.problem();
  }
}

TEST(StartUp, RefusalsAreSaidPlainly) {
  EmulatedMti device;
  device.refuses[0xC0] = 33;
  Attempt run(ImuSettings{});
  run(device);
  ASSERT_EQ(run.start.state(), State::failed);
  EXPECT_EQ(run.start.problem(),
            "the MTi refuses SetOutputConfiguration: a parameter is invalid (error 33)");
  device.refuses = {{0x10, 41}};
  run(device);
  EXPECT_THAT(run.start.problem(), AllOf(HasSubstr("GoToMeasurement"), HasSubstr("more data")));
  device.refuses = {{0x10, 99}};
  run(device);
  EXPECT_THAT(run.start.problem(), HasSubstr("(error 99)"));
}

TEST(StartUp, EveryRequestMayBeRefused) {
  const std::map<int, std::string> names = {
      {0x30, "GoToConfig"}, {0x00, "ReqDID"}, {0x18, "SetBaudrate"}, {0x40, "Reset"}};
  for (const auto& [id, name] : names) {
    EmulatedMti device;
    device.baud = 115200;
    device.refuses[id] = 40;
    Attempt run(ImuSettings{});
    run(device);
    EXPECT_EQ(run.start.problem(),
              "the MTi refuses " + name + ": the device has failed (error 40)");
  }
}

TEST(StartUp, AnErrorOfWhatWentBeforeIsNoRefusal) {
  StartUp start{ImuSettings{}};
  start.begin(0);
  start.take(test::joined({test::message(0x42, {30}), test::message(0x31, {})}), 1000);
  start.advance(start.due_ns());
  EXPECT_EQ(start.state(), State::working) << start.problem();
}

TEST(StartUp, DataSayThatItMeasures) {
  EmulatedMti device;
  device.loses[0x10] = 1;
  Attempt run(ImuSettings{});
  run(device);
  EXPECT_EQ(run.start.state(), State::measuring) << run.start.problem();
  EXPECT_THAT(device.heard, ElementsAre(0x30, 0x00, 0xC0, 0x10));
}

TEST(StartUp, SilenceIsTriedAtEveryBitRateAndThenSaid) {
  EmulatedMti device;
  device.is_silent = true;
  Attempt run(ImuSettings{});
  run(device);
  EXPECT_EQ(run.start.state(), State::failed);
  EXPECT_EQ(run.start.problem(), "no Xsens MTi answers at any bit rate");
  for (const int baud : {921600, 115200, 460800, 230400, 2000000, 57600, 9600}) {
    EXPECT_THAT(device.bauds_heard, Contains(baud));
  }
  EXPECT_LT(run.seconds(), 15);
  // And it can be begun anew.
  device.is_silent = false;
  run(device);
  EXPECT_EQ(run.start.state(), State::measuring);
}

TEST(StartUp, ADeviceThatAnswersNothingMoreIsSaid) {
  EmulatedMti device;
  device.ignores[0xC0] = 100;
  Attempt run(ImuSettings{});
  run(device);
  EXPECT_EQ(run.start.state(), State::failed);
  EXPECT_EQ(run.start.problem(), "the MTi does not answer SetOutputConfiguration");
}

TEST(StartUp, SaysWhatTheDeviceCannotDo) {
  EmulatedMti device;
  device.highest_rate = 100;
  ImuSettings settings;
  settings.rate = 200;
  Attempt run(settings);
  run(device);
  EXPECT_EQ(run.start.state(), State::measuring);
  EXPECT_EQ(run.start.note(),
            "the MTi gives orientation at 100 Hz instead of 200, acceleration at 100 Hz instead of "
            "200, rate of turn at 100 Hz instead of 200");
}

TEST(StartUp, ABitRateThatNoMtiHasIsSaid) {
  ImuSettings settings;
  settings.baud = 1'000'000;
  EmulatedMti device;
  device.baud = 115200;
  Attempt run(settings);
  run(device);
  EXPECT_EQ(run.start.state(), State::failed);
  EXPECT_THAT(run.start.problem(), AllOf(HasSubstr("115200"), HasSubstr("imu.baud = 1000000")));
}

TEST(StartUp, WakeUpIsAnswered) {
  StartUp start{ImuSettings{}};
  start.begin(0);
  start.take_output();
  start.take(test::message(0x3E, {}), 1000);
  const Bytes output = start.take_output();
  EXPECT_EQ(ByteVector(output.begin(), output.end()), test::message(0x3F, {}));
  EXPECT_TRUE(start.take_output().empty());
}

TEST(StartUp, WhatFindsNoRoomAmongTheAnswersIsLeftOut) {
  StartUp start{ImuSettings{}};
  start.begin(0);
  ByteVector bytes;
  for (int i = 0; i < 800; ++i) bytes = test::joined({bytes, test::message(0x3E, {})});
  start.take(bytes, 1000);
  const Bytes output = start.take_output();
  EXPECT_GT(output.size(), 100U);
  EXPECT_LT(output.size(), 200U);
  EXPECT_EQ(output.size() % 5, 0U) << "whole messages";
  start.take(test::message(0x31, {}), 2000);
  EXPECT_EQ(start.take_output()[2], 0x00) << "it goes on with ReqDID";
}

TEST(StartUp, NothingIsSentWhereNothingIsToBeConfigured) {
  ImuSettings settings;
  settings.configure = false;
  StartUp start(settings);
  start.begin(0);
  EXPECT_EQ(start.state(), State::measuring);
  EXPECT_TRUE(start.take_output().empty());
}

TEST(StartUp, ALineTooSlowIsSaid) {
  ImuSettings settings;
  EXPECT_FALSE(line_too_slow(settings));
  settings.rate = 400;
  EXPECT_FALSE(line_too_slow(settings));
  settings.baud = 115200;
  ASSERT_TRUE(line_too_slow(settings));
  EXPECT_THAT(*line_too_slow(settings), AllOf(HasSubstr("imu.rate"), HasSubstr("115200")));
  // A sample's message has 73 bytes, 10 bits each on the line.
  settings.baud = 73 * 10 * 400;
  EXPECT_FALSE(line_too_slow(settings));
  --settings.baud;
  EXPECT_TRUE(line_too_slow(settings));
  settings.configure = false;
  EXPECT_FALSE(line_too_slow(settings));
}

TEST(StartUp, AnyBytesAreSafe) {
  std::mt19937 random(23);
  for (int round = 0; round < 300; ++round) {
    StartUp start{ImuSettings{}};
    std::int64_t now_ns = 0;
    start.begin(now_ns);
    for (int i = 0; i < 200; ++i) {
      constexpr int kLikely[] = {0x01, 0x11, 0x19, 0x31, 0x3E, 0x41, 0x42, 0xC1, 0x36};
      ByteVector bytes;
      for (std::size_t messages = random() % 50 == 0 ? 60 : 1; messages > 0; --messages) {
        ByteVector data(random() % 3 == 0 ? random() % 100 : 0);
        for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
        const auto id = static_cast<unsigned>(kLikely[random() % 9]);
        bytes = test::joined({bytes, test::message(id, data)});
      }
      if (random() % 5 == 0) bytes[random() % bytes.size()] ^= 0xFF;
      start.take(bytes, now_ns);
      if (random() % 4 == 0) now_ns = std::min(start.due_ns(), now_ns + kSecond);
      start.advance(now_ns);
      ASSERT_LE(start.take_output().size(), 128U);
    }
    EXPECT_EQ(start.problem().empty(), start.state() != State::failed);
  }
}

}  // namespace
}  // namespace scree::xsens
