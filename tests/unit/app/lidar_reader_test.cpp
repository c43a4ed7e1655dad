#include "app/lidar_reader.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "unit/app/sending_lidar.hpp"
#include "unit/free_port.hpp"

namespace scree {
namespace {

/// Stands for a GPIO line: what is written into the pipe are the stamps of edges.
class PulsePipe {
public:
  PulsePipe() { plug_in(); }
  void plug_in() {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_NONBLOCK | O_CLOEXEC), 0);
    const std::scoped_lock lock(mutex_);
    plugged_in_ = Descriptor(ends[0]);
    writing_ = Descriptor(ends[1]);
  }
  void pulse(std::int64_t stamp_ns) const {
    EXPECT_EQ(write(writing_.get(), &stamp_ns, sizeof stamp_ns), sizeof stamp_ns);
  }
  void take_away() { writing_ = Descriptor(); }
  RobotLines::Pulses line() {
    return {[this] {
              const std::scoped_lock lock(mutex_);
              if (reading_.get() < 0) reading_ = std::exchange(plugged_in_, Descriptor());
              return reading_.get();
            },
            [this]() -> std::optional<std::int64_t> {
              std::int64_t stamp_ns = 0;
              if (read(reading_.get(), &stamp_ns, sizeof stamp_ns) <= 0) return std::nullopt;
              return stamp_ns;
            },
            [this] { reading_ = Descriptor(); }};
  }

private:
  std::mutex mutex_;
  Descriptor plugged_in_, reading_, writing_;
};

class LidarReaderTest : public ::testing::Test {
protected:
  LidarReaderTest() {
    settings_.lidar.address = "127.0.0.1";
    settings_.lidar.port = free_port();
    settings_.lidar.position_port = free_port();
    auto ports = LidarPorts::open(settings_.lidar);
    EXPECT_TRUE(ports) << ports.error().message;
    reader_.emplace(settings_, std::move(*ports), pulses_.line(), sweeps_);
    thread_ = std::thread([this] { reader_->run(); });
  }
  ~LidarReaderTest() override {
    reader_->stop();
    thread_.join();
  }

  /// Looks every 50 ms until it holds; false after a minute.
  bool until(const std::function<bool(const LidarStatus&)>& holds) {
    for (int i = 0; i < 1200; ++i) {
      if (holds(reader_->status())) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }

  Settings settings_;
  PulsePipe pulses_;
  SweepPool sweeps_{3, [] { return TimedSweep(); }};
  std::optional<LidarReader> reader_;
  std::thread thread_;
};

TEST_F(LidarReaderTest, PulsesLockTheLidarsClock) {
  const SendingLidar lidar(settings_.lidar.port);
  ASSERT_TRUE(
      until([](const LidarStatus& status) { return status.clock.state == ClockState::estimated; }));
  EXPECT_EQ(reader_->status().pulses, 0U);
  EXPECT_TRUE(until([&](const LidarStatus& status) {
    pulses_.pulse(lidar.last_second_ns());
    return status.clock.state == ClockState::pps_locked;
  }));
  EXPECT_GE(reader_->status().pulses, 3U);
}

TEST_F(LidarReaderTest, GoesOnWithoutTheLineWhenItsChipIsGoneAndTakesItUpAgain) {
  pulses_.take_away();
  EXPECT_TRUE(until([](const LidarStatus& status) { return status.is_pps_lost; }));
  const SendingLidar lidar(settings_.lidar.port);
  EXPECT_TRUE(until([](const LidarStatus& status) { return status.lidar.sweeps > 0; }));
  EXPECT_EQ(reader_->status().pulses, 0U);
  pulses_.plug_in();
  EXPECT_TRUE(until([](const LidarStatus& status) { return !status.is_pps_lost; }));
  pulses_.pulse(lidar.last_second_ns());
  EXPECT_TRUE(until([](const LidarStatus& status) { return status.pulses == 1; }));
}

TEST_F(LidarReaderTest, APulseThatTheLidarDoesNotHearMeansNothing) {
  const SendingLidar lidar(settings_.lidar.port);
  constexpr std::array<std::uint8_t, 512> kWithoutPulse{};
  LocalSender(settings_.lidar.position_port)(kWithoutPulse);
  ASSERT_TRUE(until([](const LidarStatus& status) {
    return status.has_no_pulse && status.clock.state == ClockState::estimated;
  }));
  EXPECT_TRUE(until([&](const LidarStatus& status) {
    pulses_.pulse(lidar.last_second_ns());
    return status.pulses > 20;
  }));
  EXPECT_EQ(reader_->status().clock.state, ClockState::estimated);
}

}  // namespace
}  // namespace scree
