#include "scree/drivers/velodyne/lidar_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "scree/core/nanoseconds.hpp"
#include "turning_sensor.hpp"

namespace scree::velodyne {
namespace {

TEST(LidarStreamFaults, RunsOnAcrossTheFullHourWithAndWithoutLoss) {
  for (const int missing : {0, 300}) {
    TurningSensor sensor;
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

TEST(LidarStreamFaults, CountsLossDuplicatesAndLatePackets) {
  TurningSensor sensor;
  for (int i = 0; i < 100; ++i) sensor.send();
  const PacketBuilder overtaken = sensor.packet();
  sensor.skip();
  for (int i = 0; i < 9; ++i) sensor.skip();
  const PacketBuilder next = sensor.packet();
  sensor.send(next);
  EXPECT_EQ(sensor.counters().lost, 10U) << "too many to wait for";
  sensor.stream().take(next.bytes(), kEpoch + sensor.elapsed_ns());
  sensor.stream().take(overtaken.bytes(), kEpoch + sensor.elapsed_ns());
  EXPECT_EQ(sensor.refused(Refusal::duplicate), 1U);
  EXPECT_EQ(sensor.refused(Refusal::late), 1U);
  EXPECT_EQ(sensor.counters().accepted, 101U);
}

TEST(LidarStreamFaults, OfTwoSensorsWithOneAddressOneIsTaken) {
  // The second one's clock is set by the same GPS, runs beside the first one's, or by itself.
  for (const std::int64_t ahead : {std::int64_t{kPacketNs / 3}, 20 * kMillisecond, 100 * kSecond}) {
    TurningSensor sensor;
    for (int i = 0; i < 1000; ++i) {
      PacketBuilder second = sensor.packet();
      const std::int64_t later = sensor.elapsed_ns() + kPacketNs / 3;
      second.timestamp(static_cast<std::uint32_t>(
          (sensor.stamp_at_start_ns + sensor.elapsed_ns() + ahead) / 1000));
      second.turn(static_cast<int>(later / kMillisecond * 18 + 9000) % kFullTurn, 20);
      sensor.send();
      sensor.stream().take(second.bytes(), kEpoch + later + kPacketNs);
    }
    sensor.stream().flush();
    EXPECT_GT(sensor.refused(Refusal::second_sensor) + sensor.refused(Refusal::late), 950U)
        << ahead;
    EXPECT_LE(sensor.counters().accepted, 1050U) << ahead;
    EXPECT_LE(sensor.counters().device_restarts, 1U);
  }
}

TEST(LidarStreamFaults, PacketsThatOvertookOthersArePutInOrder) {
  std::mt19937 random(4);
  TurningSensor sensor;
  std::vector<std::pair<PacketBuilder, std::int64_t>> sent;
  for (int i = 0; i < 3000; ++i) {
    sent.emplace_back(sensor.packet(), sensor.elapsed_ns() + sensor.duration());
    sensor.skip();
  }
  // One in ten comes three packets early.
  for (std::size_t i = 10; i < sent.size(); ++i) {
    if (random() % 10 != 0) continue;
    std::rotate(sent.begin() + static_cast<std::ptrdiff_t>(i) - 3,
                sent.begin() + static_cast<std::ptrdiff_t>(i),
                sent.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    for (std::size_t j = i - 3; j <= i; ++j) {
      sent[j].second = static_cast<std::int64_t>(j + 1) * sensor.duration();
    }
  }
  for (const auto& [packet, sent_ns] : sent) {
    sensor.stream().take(packet.bytes(), kEpoch + sent_ns + sensor.delay_ns);
  }
  sensor.stream().flush();
  EXPECT_EQ(sensor.counters().accepted, 3000U);
  EXPECT_EQ(sensor.counters().lost + sensor.counters().all_refused(), 0U);
  EXPECT_EQ(sensor.counters().device_restarts + sensor.counters().host_steps, 0U);
}

TEST(LidarStreamFaults, WhatIsLostIsCountedOnceTheOthersHaveWaited) {
  TurningSensor sensor;
  for (int i = 0; i < 100; ++i) sensor.send();
  sensor.skip();
  const PacketBuilder early = sensor.packet();
  sensor.send(early);
  EXPECT_EQ(sensor.counters().accepted, 100U) << "it waits for the one before it";
  sensor.stream().take(early.bytes(), kEpoch + sensor.elapsed_ns());
  EXPECT_EQ(sensor.refused(Refusal::duplicate), 1U);
  for (int i = 0; i < 6; ++i) sensor.send();
  EXPECT_EQ(sensor.counters().accepted, 107U);
  EXPECT_EQ(sensor.counters().lost, 1U);
}

TEST(LidarStreamFaults, StampsJustPastTheHourAreTakenModuloTheHour) {
  TurningSensor sensor;
  sensor.stamp_at_start_ns = kHourNs - kSecond / 2;
  for (int i = 0; i < 700; ++i) {
    PacketBuilder packet = sensor.packet();
    const std::uint32_t stamp = timestamp_us(packet.bytes());
    if (stamp < 60'000) packet.timestamp(kHourUs + stamp);
    sensor.send(packet);
  }
  EXPECT_EQ(sensor.counters().accepted, 700U);
  EXPECT_EQ(sensor.counters().lost + sensor.counters().all_refused(), 0U);
}

TEST(LidarStreamFaults, AFieldOfViewSetInTheSensorIsNoLoss) {
  TurningSensor sensor;
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

TEST(LidarStreamFaults, ARestartBeginsANewSweep) {
  TurningSensor sensor;
  sensor.send_for(1.03);
  const std::size_t before = sensor.seen.size();
  sensor.stamp_at_start_ns = -sensor.elapsed_ns();
  sensor.send_for(0.2);
  EXPECT_EQ(sensor.counters().device_restarts, 1U);
  EXPECT_EQ(sensor.counters().lost, 0U);
  EXPECT_GT(sensor.seen.size(), before);
  sensor.send_for(0.8);
  ASSERT_GE(sensor.seen.size(), before + 11);
  const auto first = std::ranges::find(sensor.seen, true, &Seen::started_over);
  EXPECT_EQ(first - sensor.seen.begin(), static_cast<std::ptrdiff_t>(before) + 1);
  for (std::size_t i = sensor.seen.size() - 8; i < sensor.seen.size(); ++i) {
    EXPECT_TRUE(sensor.seen[i].is_whole);
    EXPECT_NEAR(static_cast<double>(sensor.seen[i].end_ns - sensor.seen[i].begin_ns), 1e8, 2e5);
  }
}

TEST(LidarStreamFaults, ATurnThatARestartBreaksOffKeepsItsTime) {
  for (const std::int64_t ahead : {1'234 * kSecond, -1'234 * kSecond, 5 * kSecond}) {
    TurningSensor sensor;
    sensor.send_for(1.03);
    const std::size_t before = sensor.seen.size();
    const std::int64_t silent_ns = kEpoch + sensor.elapsed_ns();
    for (int i = 0; i < 500; ++i) sensor.skip();
    sensor.stamp_at_start_ns += ahead;
    sensor.send_for(0.5);
    ASSERT_GT(sensor.seen.size(), before);
    EXPECT_NEAR(static_cast<double>(sensor.seen[before].end_ns - silent_ns), 0, 1e6);
    for (std::size_t i = 1; i < sensor.seen.size(); ++i) {
      EXPECT_GE(sensor.seen[i].end_ns, sensor.seen[i - 1].end_ns);
    }
  }
}

TEST(LidarStreamFaults, AShortCapturePlayedInALoopKeepsItsSweeps) {
  TurningSensor sensor;
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

TEST(LidarStreamFaults, EarlyFirmwareLosesNothing) {
  for (const ReturnMode mode : {ReturnMode::strongest, ReturnMode::dual}) {
    TurningSensor sensor;
    sensor.product = Product::hdl32e;
    sensor.mode = mode;
    sensor.send();
    for (int i = 0; i < 9; ++i) sensor.skip();  // with packets lost in between nothing is decided
    sensor.send();
    EXPECT_EQ(sensor.counters().accepted, 0U);
    EXPECT_EQ(sensor.stream().firmware(), Firmware::undecided);
    sensor.send();
    EXPECT_EQ(sensor.stream().firmware(), Firmware::early_vlp16);
    EXPECT_EQ(sensor.counters().accepted, 3U);
    sensor.send_for(0.5);
    EXPECT_EQ(sensor.counters().all_refused(), 0U);
    EXPECT_EQ(sensor.counters().lost, 9U);
    EXPECT_FALSE(sentence(sensor.stream().firmware()).empty());
  }
}

TEST(LidarStreamFaults, AnHdl32eIsRefusedAltogether) {
  TurningSensor sensor;
  sensor.product = Product::hdl32e;
  std::uint32_t stamp = 1000;
  for (int i = 0; i < 100; ++i, stamp += i % 10 == 0 ? 552 : 553) {
    const PacketBuilder packet = sensor.packet().timestamp(stamp);
    if (i % 7 != 1) sensor.stream().take(packet.bytes(), kEpoch + stamp * 1000LL);
  }
  EXPECT_EQ(sensor.stream().firmware(), Firmware::hdl32e);
  EXPECT_EQ(sensor.counters().accepted, 0U);
  EXPECT_EQ(sensor.refused(Refusal::timing), 86U - 1U);
}

TEST(LidarStreamFaults, UndecidedPacketsAreRefusedAtTheEnd) {
  TurningSensor sensor;
  sensor.product = Product::hdl32e;
  sensor.send();
  sensor.stream().flush();
  EXPECT_EQ(sensor.refused(Refusal::timing), 1U);
  EXPECT_TRUE(sensor.seen.empty());
}

TEST(LidarStreamFaults, SurvivesAnyBytes) {
  std::mt19937 random(9);
  TurningSensor sensor;
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
