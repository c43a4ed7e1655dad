#include "scree/drivers/velodyne/lidar_stream.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "packet_builder.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree::velodyne {
namespace {

constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

struct Seen {
  std::int64_t begin_ns, end_ns;
  std::size_t points;
  std::uint32_t packets;
  bool is_whole;
};

/// A VLP-16 that turns evenly and sees a wall 5 m away, and the stream that listens to it.
class Sensor {
public:
  explicit Sensor(const LidarSettings& settings = {})
      : stream_(std::make_unique<LidarStream>(settings, [this](Sweep& sweep) {
          seen.push_back({sweep.end_ns + (sweep.points.empty() ? 0 : sweep.time_ns[0]),
                          sweep.end_ns, sweep.points.size(), sweep.packets, sweep.is_whole});
          for (std::size_t i = 1; i < sweep.time_ns.size(); ++i) {
            EXPECT_GE(sweep.time_ns[i], sweep.time_ns[i - 1]);
          }
          if (!sweep.time_ns.empty()) {
            EXPECT_EQ(sweep.time_ns.back(), 0);
          }
        })) {}

  ReturnMode mode = ReturnMode::strongest;
  Product product = Product::vlp16;
  double turns_per_second = 10;
  std::int64_t stamp_at_start_ns = 100 * kSecond;
  std::int64_t delay_ns = 100'000;
  std::vector<Seen> seen;

  PacketBuilder packet() const {
    PacketBuilder packet;
    packet.mode(mode).product(product).all_shots(2500, 30);
    const int pairs = mode == ReturnMode::dual ? 2 : 1;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const auto at = elapsed_ns_ + static_cast<std::int64_t>(block) / pairs * kBlockNs;
      const double turns = turns_per_second * static_cast<double>(at) * 1e-9;
      packet.azimuth(block, static_cast<int>(36000 * (turns - std::floor(turns))) % kFullTurn);
    }
    packet.timestamp(
        static_cast<std::uint32_t>((stamp_at_start_ns + elapsed_ns_) / 1000 % kHourUs));
    return packet;
  }
  std::int64_t duration() const { return packet_duration_ns(mode); }
  void skip() { elapsed_ns_ += duration(); }
  void send() { send(packet()); }
  void send(const PacketBuilder& packet) {
    stream_->take(packet.bytes(), kEpoch + elapsed_ns_ + duration() + delay_ns);
    skip();
  }
  void send_for(double seconds) {
    for (const auto end = elapsed_ns_ + static_cast<std::int64_t>(seconds * 1e9);
         elapsed_ns_ < end;) {
      send();
    }
  }
  LidarStream& stream() { return *stream_; }
  const LidarCounters& counters() const { return stream_->counters(); }
  std::uint64_t refused(Refusal reason) const {
    return counters().refused[static_cast<std::size_t>(reason)];
  }
  std::int64_t elapsed_ns() const { return elapsed_ns_; }

private:
  std::int64_t elapsed_ns_ = 0;
  std::unique_ptr<LidarStream> stream_;
};

TEST(LidarStream, CutsATurnWhereTheAzimuthPasses) {
  for (const double rate : {5.0, 10.0, 20.0}) {
    for (const double cut : {0.0, 90.0, 359.99}) {
      for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
        LidarSettings settings;
        settings.cut_azimuth_deg = cut;
        Sensor sensor(settings);
        sensor.turns_per_second = rate;
        sensor.mode = mode;
        sensor.send_for(2.0);
        sensor.stream().flush();
        SCOPED_TRACE(testing::Message() << rate << " Hz, cut at " << cut);
        const auto turns = static_cast<std::size_t>(2 * rate);
        ASSERT_NEAR(static_cast<double>(sensor.seen.size()), static_cast<double>(turns), 1.1);
        for (std::size_t i = 1; i + 1 < sensor.seen.size(); ++i) {
          const Seen& sweep = sensor.seen[i];
          EXPECT_TRUE(sweep.is_whole);
          EXPECT_NEAR(static_cast<double>(sweep.end_ns - sweep.begin_ns), 1e9 / rate, 2e5);
          // All the shots of a turn; equal dual returns count once.
          EXPECT_NEAR(static_cast<double>(sweep.points), 16 / (55.296e-6 * rate), 40);
          EXPECT_NEAR(static_cast<double>(sweep.packets),
                      1e9 / rate / static_cast<double>(sensor.duration()), 2.1);
          const double ends_at = (static_cast<double>(i) + cut / 360.0) / rate;
          EXPECT_NEAR(static_cast<double>(sweep.end_ns - kEpoch - sensor.delay_ns) * 1e-9,
                      ends_at + (cut == 0.0 ? 1 / rate : 0.0), 3e-4);
        }
        EXPECT_FALSE(sensor.seen.front().is_whole);
        EXPECT_FALSE(sensor.seen.back().is_whole);
        EXPECT_EQ(sensor.counters().lost, 0U);
        EXPECT_EQ(sensor.counters().dropped, 0U);
      }
    }
  }
}

TEST(LidarStream, DifferentDualReturnsAreTwoPoints) {
  Sensor sensor;
  sensor.mode = ReturnMode::dual;
  PacketBuilder packet = sensor.packet();
  packet.shot(0, 2600, 30);
  packet.shot(1, 0, 0);
  sensor.send(packet);
  sensor.stream().flush();
  ASSERT_EQ(sensor.seen.size(), 1U);
  EXPECT_EQ(sensor.seen[0].points, 6U * 32 + 1);
}

TEST(LidarStream, ASensorThatStandsStillGivesSweepsByTime) {
  Sensor sensor;
  sensor.turns_per_second = 0;
  sensor.send_for(2.0);
  ASSERT_GE(sensor.seen.size(), 8U);
  for (const Seen& sweep : sensor.seen) {
    EXPECT_NEAR(static_cast<double>(sweep.end_ns - sweep.begin_ns), kLongestSweepNs, 1e5);
    EXPECT_FALSE(sweep.is_whole);
  }
  EXPECT_EQ(sensor.counters().dropped, 0U);
}

TEST(LidarStream, AWaveringAzimuthAtTheCutMakesNoShreds) {
  Sensor sensor;
  sensor.turns_per_second = 0;
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    PacketBuilder packet = sensor.packet();
    for (std::size_t block = 0; block < kBlocks; ++block) {
      packet.azimuth(block, random() % 2 == 0 ? 35999 : 1);
    }
    sensor.send(packet);
  }
  EXPECT_LE(sensor.seen.size(), 140U);
}

TEST(LidarStream, KnowsHowLongThereHasBeenNoReturn) {
  Sensor sensor;
  sensor.send_for(0.5);
  EXPECT_LT(sensor.stream().without_return_ns(), kBlockNs);
  const std::int64_t begin = sensor.elapsed_ns();
  while (sensor.elapsed_ns() - begin < kSecond / 4) sensor.send(sensor.packet().all_shots(0, 0));
  EXPECT_NEAR(static_cast<double>(sensor.stream().without_return_ns()),
              static_cast<double>(sensor.elapsed_ns() - begin), 1e5);
  sensor.send();
  EXPECT_LT(sensor.stream().without_return_ns(), kBlockNs);
}

TEST(LidarStream, EmptyTurnsAreHandedOutToo) {
  Sensor sensor;
  for (int i = 0; i < 200; ++i) sensor.send(sensor.packet().all_shots(0, 0));
  ASSERT_GE(sensor.seen.size(), 2U);
  EXPECT_EQ(sensor.seen[1].points, 0U);
  EXPECT_GT(sensor.seen[1].end_ns, sensor.seen[0].end_ns);
}

TEST(LidarStream, RunsOnAcrossTheFullHourWithAndWithoutLoss) {
  for (const int missing : {0, 300}) {
    Sensor sensor;
    sensor.stamp_at_start_ns = kHourNs - kSecond;
    sensor.send_for(0.9);
    for (int i = 0; i < missing; ++i) sensor.skip();
    sensor.send_for(1.0);
    sensor.stream().flush();
    EXPECT_EQ(sensor.counters().lost, static_cast<std::uint64_t>(missing));
    EXPECT_EQ(sensor.counters().device_restarts + sensor.counters().host_steps, 0U);
    for (std::size_t i = 1; i < sensor.seen.size(); ++i) {
      EXPECT_GT(sensor.seen[i].end_ns, sensor.seen[i - 1].end_ns);
    }
    const std::int64_t last_shot =
        kEpoch + sensor.elapsed_ns() - kFiringNs + std::int64_t{15} * kShotNs;
    EXPECT_NEAR(static_cast<double>(sensor.seen.back().end_ns - sensor.delay_ns - last_shot), 0,
                2e3);
  }
}

TEST(LidarStream, CountsLossDuplicatesAndLatePackets) {
  Sensor sensor;
  for (int i = 0; i < 100; ++i) sensor.send();
  const PacketBuilder overtaken = sensor.packet();
  sensor.skip();
  for (int i = 0; i < 3; ++i) sensor.skip();
  const PacketBuilder next = sensor.packet();
  sensor.send(next);
  EXPECT_EQ(sensor.counters().lost, 4U);
  sensor.stream().take(next.bytes(), kEpoch + sensor.elapsed_ns());
  sensor.stream().take(overtaken.bytes(), kEpoch + sensor.elapsed_ns());
  EXPECT_EQ(sensor.refused(Refusal::duplicate), 1U);
  EXPECT_EQ(sensor.refused(Refusal::late), 1U);
  EXPECT_EQ(sensor.counters().accepted, 101U);
}

TEST(LidarStream, AFieldOfViewSetInTheSensorIsNoLoss) {
  Sensor sensor;
  // It looks from 315 to 45 degrees; in between nothing is sent, and a packet is filled up where it
  // looks again.
  const auto visible = [](double turns) {
    const double degrees = 360 * (turns - std::floor(turns));
    return degrees >= 315 || degrees < 45;
  };
  std::int64_t t = 0;
  for (int i = 0; i < 600; ++i) {
    PacketBuilder packet;
    packet.all_shots(2500, 30);
    for (std::size_t block = 0; block < kBlocks; ++block, t += kBlockNs) {
      while (!visible(10e-9 * static_cast<double>(t))) t += kBlockNs;
      if (block == 0) packet.timestamp(static_cast<std::uint32_t>(t / 1000));
      const double turns = 10e-9 * static_cast<double>(t);
      packet.azimuth(block, static_cast<int>(36000 * (turns - std::floor(turns))));
    }
    sensor.stream().take(packet.bytes(), kEpoch + t);
  }
  EXPECT_EQ(sensor.counters().lost, 0U);
  EXPECT_EQ(sensor.counters().accepted, 600U);
}

TEST(LidarStream, ARestartBeginsANewSweep) {
  Sensor sensor;
  sensor.send_for(1.03);
  const std::size_t before = sensor.seen.size();
  sensor.stamp_at_start_ns = -sensor.elapsed_ns();
  sensor.send_for(0.2);
  EXPECT_EQ(sensor.counters().device_restarts, 1U);
  EXPECT_EQ(sensor.counters().lost, 0U);
  EXPECT_GT(sensor.seen.size(), before);
  sensor.send_for(0.8);
  ASSERT_GE(sensor.seen.size(), before + 11);
  for (std::size_t i = sensor.seen.size() - 8; i < sensor.seen.size(); ++i) {
    EXPECT_TRUE(sensor.seen[i].is_whole);
    EXPECT_NEAR(static_cast<double>(sensor.seen[i].end_ns - sensor.seen[i].begin_ns), 1e8, 2e5);
  }
}

TEST(LidarStream, AShortCapturePlayedInALoopKeepsItsSweeps) {
  Sensor sensor;
  for (int loop = 0; loop < 10; ++loop) {
    sensor.stamp_at_start_ns = 100 * kSecond - sensor.elapsed_ns();
    sensor.send_for(0.4);
  }
  EXPECT_EQ(sensor.counters().all_refused(), 0U);
  EXPECT_EQ(sensor.counters().device_restarts, 9U);
  for (std::size_t i = 1; i < sensor.seen.size(); ++i) {
    EXPECT_GT(sensor.seen[i].end_ns, sensor.seen[i - 1].end_ns);
  }
}

TEST(LidarStream, SaysHowWellItsClockIsKnown) {
  Sensor sensor;
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::unsynchronised);
  sensor.send_for(1.5);
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::estimated);
  for (int second = 1; second < 5; ++second) {
    sensor.stream().pps(kEpoch + second * kSecond);
    sensor.send_for(1.0);
  }
  EXPECT_EQ(sensor.stream().clock().state(), ClockState::pps_locked);
  EXPECT_LT(sensor.stream().clock().accuracy_ns(), 1000);
  const std::int64_t late_by =
      sensor.stream().clock().status().offset_ns - (kEpoch - 100 * kSecond);
  EXPECT_NEAR(static_cast<double>(late_by % kHourNs), 0, 1000) << "there is no delay in it";
}

TEST(LidarStream, EarlyFirmwareLosesNothing) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    Sensor sensor;
    sensor.product = Product::hdl32e;
    sensor.mode = mode;
    sensor.send();
    for (int i = 0; i < 3; ++i) sensor.skip();  // with packets lost in between nothing is decided
    sensor.send();
    EXPECT_EQ(sensor.counters().accepted, 0U);
    EXPECT_EQ(sensor.stream().firmware(), Firmware::undecided);
    sensor.send();
    EXPECT_EQ(sensor.stream().firmware(), Firmware::early_vlp16);
    EXPECT_EQ(sensor.counters().accepted, 3U);
    sensor.send_for(0.5);
    EXPECT_EQ(sensor.counters().all_refused(), 0U);
    EXPECT_EQ(sensor.counters().lost, 3U);
    EXPECT_FALSE(sentence(sensor.stream().firmware()).empty());
  }
}

TEST(LidarStream, AnHdl32eIsRefusedAltogether) {
  Sensor sensor;
  sensor.product = Product::hdl32e;
  std::uint32_t stamp = 1000;
  for (int i = 0; i < 100; ++i, stamp += i % 10 == 0 ? 552 : 553) {
    const PacketBuilder packet = sensor.packet().timestamp(stamp);
    if (i % 7 != 1) sensor.stream().take(packet.bytes(), kEpoch + stamp * 1000LL);
  }
  EXPECT_EQ(sensor.stream().firmware(), Firmware::foreign);
  EXPECT_EQ(sensor.counters().accepted, 0U);
  EXPECT_EQ(sensor.refused(Refusal::timing), 86U - 1U);
}

TEST(LidarStream, UndecidedPacketsAreRefusedAtTheEnd) {
  Sensor sensor;
  sensor.product = Product::hdl32e;
  sensor.send();
  sensor.stream().flush();
  EXPECT_EQ(sensor.refused(Refusal::timing), 1U);
  EXPECT_TRUE(sensor.seen.empty());
}

TEST(LidarStream, ASweepMayBeSwappedAway) {
  Sweep mine(kSweepCapacity);
  std::size_t most = 0;
  LidarStream stream({}, [&](Sweep& sweep) {
    std::swap(mine, sweep);
    most = std::max(most, mine.points.size());
  });
  Sensor sensor;
  for (int i = 0; i < 400; ++i, sensor.skip()) {
    stream.take(sensor.packet().bytes(), kEpoch + sensor.elapsed_ns());
  }
  EXPECT_GT(most, 28000U);
  EXPECT_LT(most, 29500U);
}

TEST(LidarStream, NamesTheLaserOfEachPoint) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    std::size_t points = 0;
    LidarStream stream({}, [&](Sweep& sweep) {
      ASSERT_EQ(sweep.laser.size(), sweep.points.size());
      points += sweep.points.size();
      for (std::size_t i = 0; i < sweep.points.size(); ++i) {
        const float up =
            std::atan2(sweep.points.z[i], std::hypot(sweep.points.x[i], sweep.points.y[i]));
        const int laser = sweep.laser[i];
        const int up_deg = laser % 2 == 0 ? laser - 15 : laser;  // 63-9243 Rev. D, table 9-1
        ASSERT_NEAR(up * 180 / std::numbers::pi, up_deg, 0.2);
      }
    });
    Sensor sensor;
    sensor.mode = mode;
    for (int i = 0; i < 400; ++i, sensor.skip()) {
      stream.take(sensor.packet().bytes(), kEpoch + sensor.elapsed_ns());
    }
    EXPECT_GT(points, 28000U);
  }
}

TEST(LidarStream, HandsOutTheShotsWithoutReturn) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    int sweeps = 0;
    LidarStream stream({}, [&](Sweep& sweep) {
      if (!sweep.is_whole) return;
      ++sweeps;
      // 16 lasers a firing of 55.296 us; every fourth has no return.
      ASSERT_NEAR(static_cast<double>(sweep.points.size()), 0.75 * 28935, 60);
      ASSERT_NEAR(static_cast<double>(sweep.empty.size()), 0.25 * 28935, 60);
      std::int32_t before_ns = sweep.time_ns[0] - 1'000'000;
      for (const EmptyShot& shot : sweep.empty) {
        ASSERT_NEAR(shot.end.norm(), kNoReturnRange, 0.1);
        ASSERT_GE(shot.time_ns, before_ns);
        ASSERT_LT(shot.time_ns, 1'000'000);
        before_ns = shot.time_ns;
      }
    });
    Sensor sensor;
    sensor.mode = mode;
    for (int i = 0; i < 600; ++i, sensor.skip()) {
      PacketBuilder packet = sensor.packet();
      for (std::size_t shot = 0; shot < kShots; ++shot) {
        if (laser_of(shot) % 4 == 0) packet.shot(shot, 0, 0);
      }
      stream.take(packet.bytes(), kEpoch + sensor.elapsed_ns());
    }
    EXPECT_GE(sweeps, 2);
  }
}

TEST(LidarStream, SurvivesAnyBytes) {
  std::mt19937 random(9);
  Sensor sensor;
  for (int round = 0; round < 20000; ++round) {
    PacketBuilder packet = sensor.packet();
    const std::size_t size = random() % 10 == 0 ? random() % kDataPacketSize : kDataPacketSize;
    const bool mostly_tail = random() % 2 == 0;
    for (auto flips = random() % 5; flips > 0; --flips) {
      const std::size_t where =
          mostly_tail ? kTimestampOffset + random() % 6 : random() % kDataPacketSize;
      packet.bytes()[where] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    const auto arrival =
        kEpoch + sensor.elapsed_ns() + static_cast<std::int64_t>(random() % 100) * 1000;
    sensor.stream().take(Bytes(packet.bytes()).first(size), arrival);
    sensor.skip();
  }
  sensor.stream().flush();
  EXPECT_EQ(sensor.counters().accepted + sensor.counters().all_refused(), 20000U);
}

}  // namespace
}  // namespace scree::velodyne
