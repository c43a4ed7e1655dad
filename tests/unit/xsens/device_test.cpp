// The real transport against an emulated device on a pseudo-terminal.

#include "scree/drivers/xsens/device.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>

#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "unit/temporary_folder.hpp"
#include "unit/xsens/emulated_mti.hpp"
#include "unit/xsens/terminal_speed.hpp"

namespace scree::xsens {
namespace {

using test::ByteVector;
using test::EmulatedMti;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kPatience = 10'000;  // milliseconds, for what is sure to come

bool readable(int descriptor, int milliseconds) {
  pollfd wait_for{descriptor, POLLIN, 0};
  return poll(&wait_for, 1, milliseconds) == 1 && (wait_for.revents & POLLIN) != 0;
}

/// A pseudo-terminal with a name of its own, as udev gives one.
class Terminal {
public:
  explicit Terminal(std::filesystem::path link) : link_(std::move(link)) { plug_in(); }
  ~Terminal() { unplug(); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void plug_in() {
    master_ = Descriptor(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    EXPECT_EQ(grantpt(master_.get()), 0);
    EXPECT_EQ(unlockpt(master_.get()), 0);
    std::filesystem::create_symlink(ptsname(master_.get()), link_);
  }
  void unplug() {
    std::error_code ignored;
    std::filesystem::remove(link_, ignored);
    master_ = Descriptor();
  }
  std::string name() const { return link_.string(); }
  int speed() const { return test::terminal_speed(master_.get()); }
  int descriptor() const { return master_.get(); }

  ByteVector read() const {
    ByteVector bytes(4096);
    const ssize_t size = ::read(master_.get(), bytes.data(), bytes.size());
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }
  void write(const ByteVector& bytes) const {
    if (bytes.empty()) return;
    EXPECT_EQ(::write(master_.get(), bytes.data(), bytes.size()),
              static_cast<ssize_t>(bytes.size()));
  }

private:
  std::filesystem::path link_;
  Descriptor master_;
};

class DeviceTest : public ::testing::Test {
protected:
  DeviceTest() { settings_.device = terminal_.name(); }

  Device open() {
    auto device = Device::open(settings_);
    EXPECT_TRUE(device) << device.error().message;
    return std::move(*device);
  }

  /// Both sides take their turns until it is done; the test's clock goes on only when neither has
  /// anything to do.
  bool run_until(Device& device, const std::function<bool()>& is_done) {
    for (int i = 0; i < 2000; ++i) {
      while (const auto received = device.advance(now_ns_)) {
        stream_.take(received->bytes, received->arrival_ns);
        last_arrival_ns_ = received->arrival_ns;
      }
      if (is_done()) return true;
      const bool is_idle = !is_plugged_in_ || !let_device_act(device);
      if (is_idle) now_ns_ = std::max(now_ns_, device.due_ns());
    }
    return false;
  }
  /// False when it had nothing to do.
  bool let_device_act(const Device& device) {
    // A new date to wait for means that something was sent, which is on its way.
    const bool is_sent = device.state() == DeviceState::starting && device.due_ns() != waited_for_;
    waited_for_ = device.due_ns();
    ByteVector answer;
    if (device.state() == DeviceState::measuring) {
      if (mti_.baud == terminal_.speed()) answer = mti_.sample();
    } else if (readable(terminal_.descriptor(), is_sent ? kPatience : 0)) {
      answer = mti_.answer(terminal_.read(), terminal_.speed());
    }
    if (answer.empty()) return is_sent;
    terminal_.write(answer);
    return readable(device.descriptor(), kPatience);
  }
  bool run_until_samples(Device& device, std::size_t count) {
    const std::size_t goal = samples_ + count;
    return run_until(device, [&] { return samples_ >= goal; });
  }

  TemporaryFolder folder_;
  Terminal terminal_{folder_ / "imu"};
  EmulatedMti mti_;
  ImuSettings settings_;
  std::int64_t now_ns_ = 0, last_arrival_ns_ = 0, waited_for_ = -1;
  bool is_plugged_in_ = true;
  std::size_t samples_ = 0;
  ImuStream stream_{ImuSettings{}, [this](const ImuSample&) { ++samples_; }};
};

TEST_F(DeviceTest, StartsAndHandsOutWhatComes) {
  Device device = open();
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  ASSERT_TRUE(run_until_samples(device, 20)) << device.problem();
  EXPECT_EQ(device.state(), DeviceState::measuring);
  EXPECT_EQ(device.problem(), "");
  EXPECT_EQ(device.device_id(), 0x07712345U);
  EXPECT_EQ(device.counts().starts, 1U);
  EXPECT_EQ(stream_.counters().all_refused(), 0U);
  EXPECT_EQ(mti_.outputs.size(), 24U);
  const auto after = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_GE(last_arrival_ns_, std::chrono::nanoseconds(before).count());
  EXPECT_LE(last_arrival_ns_, std::chrono::nanoseconds(after).count());
}

TEST_F(DeviceTest, AnyByteComesThroughUnchanged) {
  settings_.configure = false;
  Device device = open();
  ByteVector sent(256), received;
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint8_t>(i);
  EXPECT_FALSE(device.advance(0));
  terminal_.write(sent);
  while (received.size() < sent.size() && readable(device.descriptor(), kPatience)) {
    while (const auto bytes = device.advance(0)) {
      received.insert(received.end(), bytes->bytes.begin(), bytes->bytes.end());
    }
  }
  EXPECT_EQ(received, sent);
  EXPECT_TRUE(terminal_.read().empty()) << "nothing is sent or echoed";
}

TEST_F(DeviceTest, SetsAnyBitRate) {
  settings_.configure = false;
  for (const int baud : {9600, 115200, 250000, 921600, 2'000'000, 3'500'000}) {
    settings_.baud = baud;
    Device device = open();
    device.advance(0);
    EXPECT_EQ(terminal_.speed(), baud);
  }
}

TEST_F(DeviceTest, FindsTheDeviceAtAnotherBitRate) {
  mti_.baud = 460800;
  Device device = open();
  ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
  EXPECT_EQ(mti_.baud, 921600);
  EXPECT_EQ(terminal_.speed(), 921600);
}

TEST_F(DeviceTest, ARefusalIsSaidAndTriedAgain) {
  mti_.refuses[0xC0] = 33;
  Device device = open();
  ASSERT_TRUE(run_until(device, [&] { return !device.problem().empty(); }));
  EXPECT_EQ(device.state(), DeviceState::lost);
  EXPECT_THAT(device.problem(), AllOf(HasSubstr("refuses SetOutputConfiguration"),
                                      HasSubstr("error 33"), HasSubstr(terminal_.name())));
  EXPECT_GE(device.due_ns(), now_ns_ + kSecond) << "no busy loop";
  mti_.refuses.clear();
  EXPECT_TRUE(run_until_samples(device, 5)) << device.problem();
}

TEST_F(DeviceTest, SilenceFromTheStartIsSaidAndTriedAgain) {
  mti_.is_silent = true;
  Device device = open();
  ASSERT_TRUE(run_until(device, [&] { return !device.problem().empty(); }));
  EXPECT_THAT(device.problem(), HasSubstr("no Xsens MTi answers at any bit rate"));
  mti_.is_silent = false;
  EXPECT_TRUE(run_until_samples(device, 5)) << device.problem();
}

TEST_F(DeviceTest, ADeviceThatFallsSilentIsStartedAnew) {
  Device device = open();
  ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
  mti_.is_measuring = false;  // it lost its power and waits
  ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
  EXPECT_EQ(device.counts().silences, 1U);
  EXPECT_EQ(device.counts().starts, 2U);
  EXPECT_THAT(device.problem(), HasSubstr("has stopped sending"));
}

TEST_F(DeviceTest, AnotherDeviceAtAnotherBitRateIsFoundBehindTheSameAdapter) {
  Device device = open();
  ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
  mti_.baud = 115200;
  for (int i = 0; i < 40 && device.state() == DeviceState::measuring; ++i) {
    terminal_.write({0x80, 0x00, 0xFF});  // what the wrong bit rate makes of its data
    ASSERT_TRUE(readable(device.descriptor(), kPatience));
    now_ns_ += kSecond / 10;
    while (device.advance(now_ns_)) {
    }
  }
  EXPECT_THAT(device.problem(), HasSubstr("sends nothing that can be understood"));
  EXPECT_EQ(device.counts().silences, 1U);
  ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
  EXPECT_EQ(mti_.baud, 921600);
}

TEST_F(DeviceTest, ComesBackAfterUnplugging) {
  for (const bool configure : {true, false}) {
    settings_.configure = configure;
    mti_.is_measuring = true;
    Device device = open();
    ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
    for (std::uint64_t time = 1; time <= 3; ++time) {
      terminal_.unplug();
      is_plugged_in_ = false;
      ASSERT_TRUE(run_until(device, [&] { return device.state() == DeviceState::lost; }));
      EXPECT_EQ(device.descriptor(), -1);
      EXPECT_THAT(device.problem(), HasSubstr("has gone"));
      EXPECT_EQ(device.counts().losses, time);
      const std::int64_t lost_ns = now_ns_;
      ASSERT_TRUE(run_until(device, [&] { return now_ns_ > lost_ns + 3 * kSecond; }));
      EXPECT_THAT(device.problem(), HasSubstr("is not there"));
      terminal_.plug_in();
      is_plugged_in_ = true;
      mti_.is_measuring = true;
      ASSERT_TRUE(run_until_samples(device, 5)) << device.problem();
      EXPECT_EQ(device.counts().starts, time + 1);
    }
  }
}

TEST_F(DeviceTest, UnpluggingWhileItStartsIsSurvivedToo) {
  mti_.ignores[0xC0] = 1;
  Device device = open();
  ASSERT_TRUE(run_until(device, [&] { return mti_.heard_any(0xC0); }));
  EXPECT_EQ(device.state(), DeviceState::starting);
  terminal_.unplug();
  is_plugged_in_ = false;
  ASSERT_TRUE(run_until(device, [&] { return device.state() == DeviceState::lost; }));
  terminal_.plug_in();
  is_plugged_in_ = true;
  EXPECT_TRUE(run_until_samples(device, 5)) << device.problem();
}

TEST_F(DeviceTest, APortBelongsToOneProgram) {
  const Device device = open();
  const auto second = Device::open(settings_);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message,
              AllOf(HasSubstr(terminal_.name()), HasSubstr("in use by another program")));
}

TEST_F(DeviceTest, WhatCannotBeOpenedIsOneSentence) {
  const auto error_of = [&](const std::string& name) {
    settings_.device = name;
    const auto device = Device::open(settings_);
    return device ? "no error" : device.error().message;
  };
  EXPECT_THAT(error_of((folder_ / "none").string()),
              AllOf(HasSubstr("none is not there"), HasSubstr("plugged in?")));
  EXPECT_THAT(error_of("/dev/null"), HasSubstr("/dev/null is no serial port"));
  EXPECT_THAT(error_of((folder_ / "").string()), HasSubstr("is no serial port"));
  settings_.rate = 400;
  settings_.baud = 115200;
  EXPECT_THAT(error_of(terminal_.name()), HasSubstr("more than imu.baud = 115200"));
}

}  // namespace
}  // namespace scree::xsens
