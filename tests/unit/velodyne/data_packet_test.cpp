#include "scree/drivers/velodyne/data_packet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "packet_builder.hpp"
#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/lasers.hpp"

namespace scree::velodyne {
namespace {

Shots decode(const PacketBuilder& packet, LidarModel model = LidarModel::vlp16) {
  EXPECT_EQ(check_data_packet(packet.bytes(), model), Refusal::none);
  Shots shots;
  PacketDecoder(model).decode(packet.bytes(), shots);
  return shots;
}

double degrees_apart(double a, double b) {
  return std::remainder(a - b, 360.0);
}

/// The manual's formulas written down plainly, in double precision; steps[block] is what the sensor
/// turns from this block to the next, in degrees.
struct Reference {
  double azimuth_deg, time_us, x, y, z;

  Reference(const std::vector<double>& block_azimuth_deg, const std::vector<double>& steps_deg,
            std::size_t shot, double range, bool dual, const Lasers& lasers) {
    const std::size_t block = shot / 32, firing = shot % 32 / 16, laser = shot % 16;
    const double within_us =
        55.296 * static_cast<double>(firing) + 2.304 * static_cast<double>(laser);
    time_us = 2 * 55.296 * static_cast<double>(dual ? block / 2 : block) + within_us;
    azimuth_deg =
        std::fmod(block_azimuth_deg[block] + steps_deg[block] * within_us / (2 * 55.296), 360.0);
    const double azimuth = radians(azimuth_deg), elevation = radians(lasers[laser].elevation_deg);
    x = range * std::cos(elevation) * std::cos(azimuth);
    y = -range * std::cos(elevation) * std::sin(azimuth);
    z = range * std::sin(elevation) + lasers[laser].correction_mm / 1000.0;
  }
};

void expect_agrees(const Shots& shots, const std::vector<double>& azimuths,
                   const std::vector<double>& steps, const Lasers& lasers) {
  const bool dual = shots.mode == ReturnMode::dual;
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    const double range = static_cast<double>(shots.range[shot]);
    const Reference expected(azimuths, steps, shot, range, dual, lasers);
    SCOPED_TRACE(shot);
    // Single precision at 131 m resolves 8 micrometres.
    ASSERT_NEAR(shots.x[shot], expected.x, 4e-5);
    ASSERT_NEAR(shots.y[shot], expected.y, 4e-5);
    ASSERT_NEAR(shots.z[shot], expected.z, 2e-5);
    ASSERT_NEAR(
        degrees_apart(static_cast<double>(shots.azimuth[shot]) / 100.0, expected.azimuth_deg), 0,
        3e-5);
    ASSERT_GE(shots.azimuth[shot], 0.0F);
    ASSERT_LT(shots.azimuth[shot], 36000.0F);
    ASSERT_NEAR(shots.time_ns[shot], 1000 * expected.time_us, 1e-3);
  }
}

std::vector<double> turned(double first, double step, bool dual) {
  std::vector<double> azimuths;
  azimuths.reserve(12);
  for (int block = 0; block < 12; ++block) {
    azimuths.push_back(std::fmod(first + step * (dual ? block / 2 : block), 360.0));
  }
  return azimuths;
}

PacketBuilder far_and_near() {
  PacketBuilder packet;
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    packet.shot(shot, static_cast<std::uint16_t>(65535 - 170 * shot),
                static_cast<std::uint8_t>(shot % 256));
  }
  return packet;
}

TEST(Lasers, AreThoseOfTheManual) {
  constexpr std::array<double, 16> vlp16_deg = {-15, 1, -13, 3,  -11, 5,  -9, 7,
                                                -7,  9, -5,  11, -3,  13, -1, 15};
  constexpr std::array<double, 16> vlp16_mm = {11.2, -0.7, 9.7, -2.2, 8.1, -3.7, 6.6, -5.1,
                                               5.1,  -6.6, 3.7, -8.1, 2.2, -9.7, 0.7, -11.2};
  constexpr std::array<double, 16> hires_deg = {-10.00, 0.67, -8.67, 2.00, -7.33, 3.33,
                                                -6.00,  4.67, -4.67, 6.00, -3.33, 7.33,
                                                -2.00,  8.67, -0.67, 10.00};
  constexpr std::array<double, 16> hires_mm = {7.4, -0.9, 6.5, -1.8, 5.5, -2.7, 4.6, -3.7,
                                               3.7, -4.6, 2.7, -5.5, 1.8, -6.5, 0.9, -7.4};
  EXPECT_EQ(&lasers_of(LidarModel::puck_lite), &lasers_of(LidarModel::vlp16));
  for (std::size_t i = 0; i < kLasers; ++i) {
    EXPECT_EQ(kVlp16Lasers[i].elevation_deg, vlp16_deg[i]);
    EXPECT_EQ(kVlp16Lasers[i].correction_mm, vlp16_mm[i]);
    EXPECT_NEAR(kPuckHiResLasers[i].elevation_deg, hires_deg[i], 0.005);
    EXPECT_EQ(kPuckHiResLasers[i].correction_mm, hires_mm[i]);
  }
}

TEST(PacketDecoder, RangeAndReflectivityAreTheWires) {
  const Shots shots = decode(far_and_near());
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    EXPECT_EQ(shots.range[shot], static_cast<float>(65535 - 170 * static_cast<int>(shot)) / 500.0F);
    EXPECT_EQ(shots.reflectivity[shot], static_cast<float>(shot % 256));
  }
}

TEST(PacketDecoder, AShotWithoutReturnLiesFarOffAlongItsBeam) {
  PacketBuilder packet;
  packet.turn(12345, 40);
  const Shots shots = decode(packet);
  const std::vector<double> azimuths = turned(123.45, 0.40, false), steps(12, 0.40);
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    const Reference expected(azimuths, steps, shot, 1000, false, kVlp16Lasers);
    ASSERT_EQ(shots.range[shot], 0);
    ASSERT_NEAR(shots.x[shot], expected.x, 1e-3);
    ASSERT_NEAR(shots.y[shot], expected.y, 1e-3);
    ASSERT_NEAR(shots.z[shot], expected.z, 1e-3);
  }
}

TEST(PacketDecoder, AgreesWithTheManualAllAround) {
  for (const int step : {0, 20, 40, 79, 80}) {
    for (int first = 0; first < kFullTurn; first += 307) {
      PacketBuilder packet = far_and_near();
      packet.turn(first, step);
      SCOPED_TRACE(first);
      expect_agrees(decode(packet), turned(first / 100.0, step / 100.0, false),
                    std::vector<double>(12, step / 100.0), kVlp16Lasers);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(PacketDecoder, PuckHiResHasItsOwnLasers) {
  PacketBuilder packet = far_and_near();
  packet.product(Product::puck_hires).turn(12345, 40);
  expect_agrees(decode(packet, LidarModel::puck_hires), turned(123.45, 0.40, false),
                std::vector<double>(12, 0.40), kPuckHiResLasers);
}

TEST(PacketDecoder, DualReturnsShareTheirFiring) {
  PacketBuilder packet = far_and_near();
  packet.mode(ReturnMode::dual).turn(35900, 40);
  const Shots shots = decode(packet);
  expect_agrees(shots, turned(359.0, 0.40, true), std::vector<double>(12, 0.40), kVlp16Lasers);
  // In the order of time the two returns of a shot follow each other.
  for (std::size_t i = 0; i < kShots; i += 2) {
    const std::size_t a = shots.firing_order[i], b = shots.firing_order[i + 1];
    EXPECT_EQ(b, a + kShotsPerBlock);
    EXPECT_EQ(shots.time_ns[a], shots.time_ns[b]);
    EXPECT_EQ(shots.azimuth[a], shots.azimuth[b]);
    if (i > 0) {
      EXPECT_GT(shots.time_ns[a], shots.time_ns[shots.firing_order[i - 1]]);
    }
  }
}

TEST(PacketDecoder, EachBlockTurnsTowardsTheNextAndTheLastAsBefore) {
  PacketBuilder packet = far_and_near();
  std::vector<double> azimuths, steps;
  int azimuth = 35800;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const int step = 38 + static_cast<int>(block % 4);
    packet.azimuth(block, azimuth % kFullTurn);
    azimuths.push_back(azimuth % kFullTurn / 100.0);
    steps.push_back(block + 1 < kBlocks ? step / 100.0 : steps.back());
    azimuth += step;
  }
  expect_agrees(decode(packet), azimuths, steps, kVlp16Lasers);
}

TEST(PacketDecoder, AzimuthOf36000IsZero) {
  PacketBuilder packet = far_and_near();
  packet.turn(35800, 40).azimuth(5, 36000);
  expect_agrees(decode(packet), turned(358.0, 0.40, false), std::vector<double>(12, 0.40),
                kVlp16Lasers);
}

TEST(PacketDecoder, TurnsOnAsBeforeAtTheEdgeOfAFieldOfView) {
  PacketBuilder packet = far_and_near();
  std::vector<double> azimuths;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const int azimuth = (block < 4 ? 4400 : 31500 - 160) + 40 * static_cast<int>(block);
    packet.azimuth(block, azimuth);
    azimuths.push_back(azimuth / 100.0);
  }
  const Shots shots = decode(packet);
  expect_agrees(shots, azimuths, std::vector<double>(12, 0.40), kVlp16Lasers);
  EXPECT_NEAR(shots.skipped_deg, 315.0 - 45.2, 1e-3);
  EXPECT_FLOAT_EQ(shots.degrees_per_block, 0.40F);
}

TEST(PacketDecoder, TheFirstBlockMayLieBeforeTheEdge) {
  PacketBuilder packet = far_and_near();
  packet.turn(31460, 40).azimuth(0, 4490);
  std::vector<double> azimuths = turned(314.60, 0.40, false);
  azimuths[0] = 44.90;
  expect_agrees(decode(packet), azimuths, std::vector<double>(12, 0.40), kVlp16Lasers);
}

TEST(PacketDecoder, JumpsAllOverGiveNoTurn) {
  PacketBuilder packet = far_and_near();
  std::vector<double> azimuths;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const int azimuth = static_cast<int>(block) * 7919 % kFullTurn;
    packet.azimuth(block, azimuth);
    azimuths.push_back(azimuth / 100.0);
  }
  expect_agrees(decode(packet), azimuths, std::vector<double>(12, 0.0), kVlp16Lasers);
}

TEST(CheckDataPacket, NamesEveryReason) {
  const auto check = [](const PacketBuilder& packet, LidarModel model = LidarModel::vlp16) {
    return check_data_packet(packet.bytes(), model);
  };
  const PacketBuilder good;
  EXPECT_EQ(check(good), Refusal::none);
  for (const std::size_t size : {0U, 1U, 512U, 1205U}) {
    EXPECT_EQ(check_data_packet(Bytes(good.bytes()).first(size), LidarModel::vlp16), Refusal::size);
  }
  std::vector<std::uint8_t> longer(good.bytes().begin(), good.bytes().end());
  longer.push_back(0);
  EXPECT_EQ(check_data_packet(longer, LidarModel::vlp16), Refusal::size);

  for (std::size_t block = 0; block < kBlocks; ++block) {
    PacketBuilder packet;
    packet.bytes()[block * kBlockSize + 1] = 0xDD;  // the lower lasers of an HDL-64E
    EXPECT_EQ(check(packet), Refusal::flags);
    EXPECT_EQ(check(PacketBuilder().azimuth(block, 36000)), Refusal::none);
    EXPECT_EQ(check(PacketBuilder().azimuth(block, 36001)), Refusal::azimuth);
    EXPECT_EQ(check(PacketBuilder().azimuth(block, 65535)), Refusal::azimuth);
  }
  EXPECT_EQ(check(PacketBuilder().timestamp(3'599'999'999)), Refusal::none);
  EXPECT_EQ(check(PacketBuilder().timestamp(3'600'060'000)), Refusal::none);
  EXPECT_EQ(timestamp_us(PacketBuilder().timestamp(3'600'060'000).bytes()), 60'000U);
  EXPECT_EQ(check(PacketBuilder().timestamp(3'601'000'000)), Refusal::timestamp);
  for (int byte = 0; byte < 256; ++byte) {
    const bool mode_known = byte == 0x37 || byte == 0x38 || byte == 0x39;
    EXPECT_EQ(check(PacketBuilder().mode(static_cast<ReturnMode>(byte))),
              mode_known ? Refusal::none : Refusal::return_mode);
    const PacketBuilder packet = PacketBuilder().product(static_cast<Product>(byte));
    const bool is_vlp16 = byte == 0x21 || byte == 0x22, is_hires = byte == 0x24;
    const bool is_larger = byte == 0x23 || byte == 0x28 || byte == 0x31 || byte == 0xA1;
    const Refusal other = is_larger ? Refusal::unsupported : Refusal::product;
    EXPECT_EQ(check(packet), is_vlp16 ? Refusal::none : is_hires ? Refusal::puck_hires : other);
    EXPECT_EQ(check(packet, LidarModel::puck_lite), check(packet));
    EXPECT_EQ(check(packet, LidarModel::puck_hires), is_hires   ? Refusal::none
                                                     : is_vlp16 ? Refusal::vlp16
                                                                : other);
  }
}

TEST(PacketDecoder, AnyBytesThatPassTheCheckDecodeToFiniteNumbers) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> byte(0, 255);
  const PacketDecoder decoder(LidarModel::vlp16);
  Shots shots;
  for (int round = 0; round < 2000; ++round) {
    PacketBuilder packet;
    for (std::uint8_t& b : packet.bytes()) b = static_cast<std::uint8_t>(byte(random));
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const std::uint16_t flag = kBlockFlag;
      std::memcpy(packet.bytes().data() + block * kBlockSize, &flag, sizeof flag);
      packet.azimuth(block, byte(random) * 141);
    }
    packet.product(Product::vlp16).timestamp(static_cast<std::uint32_t>(byte(random)));
    packet.mode(round % 2 == 0 ? ReturnMode::dual : ReturnMode::last);
    ASSERT_EQ(check_data_packet(packet.bytes(), LidarModel::vlp16), Refusal::none);
    decoder.decode(packet.bytes(), shots);
    for (std::size_t i = 0; i < kShots; ++i) {
      const float farthest = shots.range[i] > 0 ? 132.0F : 1.001F * kNoReturnRange;
      ASSERT_LT(std::hypot(shots.x[i], shots.y[i], shots.z[i]), farthest);
      ASSERT_TRUE(shots.azimuth[i] >= 0.0F && shots.azimuth[i] < 36000.0F);
    }
  }
}

}  // namespace
}  // namespace scree::velodyne
