#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/wire.hpp"
#include "simulator/ray_caster.hpp"

namespace scree {

struct SimulatedLidarSettings {
  LidarModel model = LidarModel::vlp16;
  velodyne::ReturnMode mode = velodyne::ReturnMode::strongest;
  double rate_hz = 10;        ///< turns a second
  double range_noise = 0.01;  ///< standard deviation, metres
  double reach = 80;          ///< metres, beyond it no return
  double lost_share = 0.005;  ///< of the returns, whatever they hit
};

/// One laser pulse and what came back.
struct SimulatedShot {
  std::int64_t t_ns = 0;
  float range = 0;                ///< as measured, metres; 0: no return
  std::uint8_t reflectivity = 0;  ///< as measured, 0..255
  std::uint8_t feature = 0;       ///< id of the feature hit more than 5 cm above or below ground
};

/// What a VLP-16 at rest on a terrain sends. Every shot is cast from its own direction at its own
/// instant (63-9243 Rev. D, section 9.5). The sensor's clock is the host's, locked to PPS.
class SimulatedLidar {
public:
  static constexpr std::size_t kMostShots = velodyne::kShots;

  /// Keeps references to terrain and caster.
  /// @param mount `lidar` in the terrain's frame
  /// @param start_ns time of the first shot, whose azimuth is 0
  SimulatedLidar(const Terrain& terrain, const RayCaster& caster,
                 const SimulatedLidarSettings& settings, const Pose& mount, std::int64_t start_ns,
                 std::uint64_t seed);

  /// Casts the shots of the next data packet.
  void advance();

  /// Of the last packet, in the order of firing; laser id is the index modulo 16.
  std::span<const SimulatedShot> shots() const { return {shots_.data(), shot_count_}; }
  std::int64_t packet_ns() const { return packet_ns_; }
  std::int64_t packet_end_ns() const { return packet_ns_ + packet_duration_ns(settings_.mode); }
  /// Turns of the motor since the start, at a time.
  double turns(std::int64_t t_ns) const;
  /// Direction of a shot in the `lidar` frame: what the sensor's model would make of its range.
  Eigen::Vector3d point_of(std::size_t shot) const;

  /// The last packet as the sensor sends it: 1206 bytes.
  std::array<std::uint8_t, velodyne::kDataPacketSize> data_packet() const;
  /// A position packet at the end of the last packet: locked to PPS, with an NMEA sentence.
  std::array<std::uint8_t, velodyne::kPositionPacketSize> position_packet() const;

private:
  struct Beam {
    double cos_elevation, sin_elevation, origin_z;
  };
  Eigen::Vector3d direction(std::size_t laser, std::int64_t t_ns) const;
  SimulatedShot cast(std::size_t laser, std::int64_t t_ns);
  std::uint16_t azimuth_counts(std::int64_t t_ns) const;

  const Terrain& terrain_;
  const RayCaster& caster_;
  SimulatedLidarSettings settings_;
  Pose mount_;
  Eigen::Matrix3d rotation_;
  std::int64_t start_ns_, packet_ns_;
  Random random_;
  std::array<Beam, velodyne::kLasers> beams_{};
  std::array<SimulatedShot, kMostShots> shots_{};
  std::size_t shot_count_;
};

}  // namespace scree
