#include "simulator/lidar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <string_view>

#include "scree/drivers/velodyne/data_packet.hpp"
#include "simulator/bare_terrain.hpp"
#include "simulator/body.hpp"

namespace scree {
namespace {

using namespace velodyne;

constexpr std::int64_t kStart = 1598612520'000000000;

struct Case {
  const char* name;
  LidarModel model;
  ReturnMode mode;
  double rate_hz;
};

void PrintTo(const Case& which, std::ostream* out) {
  *out << which.name;
}

class SimulatedLidarDecodes : public testing::TestWithParam<Case> {};

TEST_P(SimulatedLidarDecodes, ToTheShotsThatWereCast) {
  TerrainSettings terrain_settings;
  terrain_settings.size = 30;
  terrain_settings.clear_radius = 1.5;
  terrain_settings.placed_within = 10;
  const Terrain terrain(terrain_settings, 1);
  const RayCaster caster(terrain);
  SimulatedLidarSettings settings;
  settings.model = GetParam().model;
  settings.mode = GetParam().mode;
  settings.rate_hz = GetParam().rate_hz;
  const Pose mount{{0.1, 0, 0.95}, from_roll_pitch_yaw(0, radians(6), 0)};
  SimulatedLidar lidar(terrain, caster, settings, mount, kStart, 1);
  const PacketDecoder decoder(settings.model);
  const auto decoded = std::make_unique<Shots>();
  const bool dual = settings.mode == ReturnMode::dual;
  int returns = 0;
  int two_returns = 0;
  for (int packet = 0; packet < 100; ++packet) {
    lidar.advance();
    const auto bytes = lidar.data_packet();
    ASSERT_EQ(check_data_packet(bytes, settings.model), Refusal::none);
    decoder.decode(bytes, *decoded);
    EXPECT_EQ(timestamp_us(bytes), lidar.packet_ns() % kHourNs / 1000);
    for (std::size_t i = 0; i < kShots; ++i) {
      const std::size_t block = block_of(i);
      const std::size_t cast = (dual ? block / 2 : block) * kShotsPerBlock + i % kShotsPerBlock;
      const SimulatedShot& shot = lidar.shots()[cast];
      EXPECT_EQ(decoded->time_ns[i], shot.t_ns - lidar.packet_ns());
      const bool is_last = dual && block % 2 == 0;
      const float range = is_last ? shot.last_range : shot.range;
      ASSERT_NEAR(decoded->range[i], range, 0.00101);
      if (range <= 0) continue;
      ++returns;
      EXPECT_EQ(decoded->reflectivity[i], is_last ? shot.last_reflectivity : shot.reflectivity);
      two_returns += is_last && shot.last_range - shot.range > 0.3F ? 1 : 0;
      if (range != shot.range) continue;
      // Azimuths are sent in steps of 0.01 deg.
      const Eigen::Vector3d point(static_cast<double>(decoded->x[i]),
                                  static_cast<double>(decoded->y[i]),
                                  static_cast<double>(decoded->z[i]));
      const double tolerance = 0.0015 + radians(0.011) * static_cast<double>(shot.range);
      ASSERT_LT((point - lidar.point_of(cast)).norm(), tolerance) << packet << ' ' << i;
      // And the point lies on the terrain, but for the noise of its range.
      const Eigen::Vector3d in_world = mount * point;
      EXPECT_NEAR(in_world.z(), terrain.height(in_world.x(), in_world.y()), 0.6);
    }
  }
  EXPECT_GT(returns, 8000);
  EXPECT_EQ(two_returns > 0, dual);
}

INSTANTIATE_TEST_SUITE_P(
    Modes, SimulatedLidarDecodes,
    testing::Values(Case{"Vlp16Strongest", LidarModel::vlp16, ReturnMode::strongest, 10},
                    Case{"Vlp16Dual", LidarModel::vlp16, ReturnMode::dual, 10},
                    Case{"Vlp16Last20Hz", LidarModel::vlp16, ReturnMode::last, 20},
                    Case{"HiRes5Hz", LidarModel::puck_hires, ReturnMode::strongest, 5}),
    [](const testing::TestParamInfo<Case>& which) { return which.param.name; });

TEST(SimulatedLidar, TruePosesMoveItsPointsOntoTheGround) {
  TerrainSettings terrain_settings;
  terrain_settings.size = 44;
  terrain_settings.cell = 0.04;
  terrain_settings.positive = terrain_settings.negative = 0;
  const Terrain terrain(terrain_settings, 1);
  const RayCaster caster(terrain);
  const Motion motion = follow_ground(draw_track({4, 1.5}, 1), terrain, draw_body(1), kStart, 1);
  const Pose mount{{0.1, 0, 0.95}, from_roll_pitch_yaw(0, radians(6), 0)};
  SimulatedLidarSettings settings;
  settings.laser_bias = 0.005;
  SimulatedLidar lidar(terrain, caster, settings, motion, mount, kStart + 2'000'000'000, 1);
  const PacketDecoder decoder(settings.model);
  const auto decoded = std::make_unique<Shots>();
  double squares = 0;
  double squares_late = 0;  // with the pose of a tenth of a second later
  int points = 0;
  for (int packet = 0; packet < 300; ++packet) {
    lidar.advance();
    decoder.decode(lidar.data_packet(), *decoded);
    for (std::size_t i = 0; i < kShots; ++i) {
      if (decoded->range[i] <= 0 || decoded->range[i] > 8) continue;
      const Eigen::Vector3d point(static_cast<double>(decoded->x[i]),
                                  static_cast<double>(decoded->y[i]),
                                  static_cast<double>(decoded->z[i]));
      const auto off = [&](std::int64_t t_ns) {
        const Eigen::Vector3d in_world = motion.base(t_ns) * (mount * point);
        return in_world.z() - terrain.height(in_world.x(), in_world.y());
      };
      const std::int64_t t_ns = lidar.packet_ns() + decoded->time_ns[i];
      squares += std::pow(off(t_ns), 2);
      squares_late += std::pow(off(t_ns + 100'000'000), 2);
      ++points;
    }
  }
  ASSERT_GT(points, 10000);
  // Range noise and bias of a centimetre, at the beam's angle to the ground.
  EXPECT_LT(std::sqrt(squares / points), 0.005);
  EXPECT_GT(squares_late, 2 * squares);
}

TEST(SimulatedLidar, FreeRunningClockHasItsOwnHour) {
  const Terrain terrain(test::bare_terrain(4), 1);
  const RayCaster caster(terrain);
  SimulatedLidarSettings settings;
  settings.is_locked = false;
  settings.clock_offset_ns = kHourNs - 120'000'000'000 - 500'000;  // wraps half a millisecond on
  settings.clock_skew = 1e-3;
  const Motion motion{Pose{{0, 0, 1}, Eigen::Quaterniond::Identity()}};
  SimulatedLidar lidar(terrain, caster, settings, motion, Pose(), kStart, 1);
  lidar.advance();
  EXPECT_EQ(timestamp_us(lidar.data_packet()), kHourUs - 500);
  lidar.advance();
  EXPECT_EQ(timestamp_us(lidar.data_packet()), 1327 - 500 + 1);
  const auto packet = lidar.position_packet();
  EXPECT_EQ(packet[kPpsStatusOffset], 0);
  EXPECT_EQ(packet[kNmeaOffset], 0);
}

TEST(SimulatedLidar, PositionPacketCarriesTheTimeOfDay) {
  const Terrain terrain(test::bare_terrain(4), 1);
  const RayCaster caster(terrain);
  SimulatedLidar lidar(terrain, caster, {}, {{0, 0, 1}, Eigen::Quaterniond::Identity()}, kStart, 1);
  lidar.advance();
  const auto packet = lidar.position_packet();
  const std::string_view sentence(reinterpret_cast<const char*>(packet.data()) + kNmeaOffset);
  EXPECT_TRUE(sentence.starts_with("$GPRMC,110200,A,")) << sentence;
  EXPECT_NE(sentence.find(",280820,"), std::string_view::npos) << sentence;
  EXPECT_EQ(read<std::uint32_t>(packet, kPositionTimestampOffset), 120001327U);
}

}  // namespace
}  // namespace scree
