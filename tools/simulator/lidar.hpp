#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/wire.hpp"
#include "simulator/beam.hpp"
#include "simulator/dust.hpp"
#include "simulator/motion.hpp"
#include "simulator/ray_caster.hpp"

namespace scree {

struct SimulatedLidarSettings {
  LidarModel model = LidarModel::vlp16;
  velodyne::ReturnMode mode = velodyne::ReturnMode::strongest;
  double rate_hz = 10;               ///< turns a second
  double start_turn = 0;             ///< where the motor stands at the first shot, turns
  double range_noise = 0.01;         ///< standard deviation, metres
  double laser_bias = 0;             ///< standard deviation of each laser's constant error, metres
  double reach = 80;                 ///< metres, beyond it no return
  double lost_share = 0.005;         ///< of the returns, whatever they hit
  double dust_share = 0;             ///< of the shots that meet a grain in the first metres
  double dust_puffs = 0;             ///< thrown up by the wheels, a metre driven
  bool is_locked = true;             ///< to PPS, with NMEA sentences; else the clock runs free:
  std::int64_t clock_offset_ns = 0;  ///< sensor's clock minus the host's at the first shot
  double clock_skew = 0;             ///< seconds a second that the sensor's clock gains
};

/// One laser pulse and what came back.
struct SimulatedShot {
  std::int64_t t_ns = 0;
  float range = 0;                ///< as measured, metres; 0: no return
  std::uint8_t reflectivity = 0;  ///< as measured, 0..255
  std::uint16_t part = 0;         ///< of the feature or mover hit, see Echo
  float relief = 0;               ///< how far above or below, metres
  // With dual returns the last return; above stands the strongest or, where that is the last, the
  // second strongest. With one return they are equal.
  float last_range = 0;
  std::uint8_t last_reflectivity = 0;
};

/// What a VLP-16 on a moving robot sends. Every shot is cast from the sensor's pose and direction
/// at its own instant (63-9243 Rev. D, section 9.5).
class SimulatedLidar {
public:
  static constexpr std::size_t kMostShots = velodyne::kShots;

  /// Keeps references to terrain, caster, motion and movers.
  /// @param mount `lidar` in `base`
  /// @param start_ns host's time of the first shot
  SimulatedLidar(const Terrain& terrain, const RayCaster& caster,
                 const SimulatedLidarSettings& settings, const Motion& motion, const Pose& mount,
                 std::int64_t start_ns, std::uint64_t seed, std::span<const Mover> movers = {});
  /// A robot that stands at the origin.
  SimulatedLidar(const Terrain& terrain, const RayCaster& caster,
                 const SimulatedLidarSettings& settings, const Pose& mount, std::int64_t start_ns,
                 std::uint64_t seed);
  SimulatedLidar(const SimulatedLidar&) = delete;  // the beam refers to the movers
  SimulatedLidar& operator=(const SimulatedLidar&) = delete;

  /// Casts the shots of the next data packet.
  void advance();

  /// Shots of the last packet, in the order of firing; laser id is the index modulo 16.
  std::span<const SimulatedShot> shots() const { return {shots_.data(), shot_count_}; }
  std::int64_t packet_ns() const { return packet_ns_; }
  std::int64_t packet_end_ns() const { return packet_ns_ + packet_duration_ns(settings_.mode); }
  /// Where the motor stands at a time, turns.
  double turns(std::int64_t t_ns) const;
  /// Where a shot ended, `lidar` frame: what the sensor's model makes of its range, kNoReturnRange
  /// without return.
  Eigen::Vector3d point_of(std::size_t shot) const;

  /// The last packet as the sensor sends it: 1206 bytes.
  std::array<std::uint8_t, velodyne::kDataPacketSize> data_packet() const;
  /// A position packet at the end of the last packet: locked to PPS with an NMEA sentence, or
  /// without any.
  std::array<std::uint8_t, velodyne::kPositionPacketSize> position_packet() const;

private:
  struct Laser {
    double cos_elevation, sin_elevation, origin_z;
    double bias;  // metres
  };
  /// The beam's own axes in the `lidar` frame: along it, to its left and up.
  Eigen::Matrix3d axes(std::size_t laser, std::int64_t t_ns) const;
  SimulatedShot cast(std::size_t laser, std::int64_t t_ns);
  void add_dust(double range);
  float measured(const Echo& echo, std::size_t laser);
  std::uint8_t measured_reflectivity(const Echo& echo);
  std::uint16_t azimuth_counts(std::int64_t t_ns) const;
  std::uint32_t past_the_hour_us(std::int64_t t_ns) const;

  SimulatedLidarSettings settings_;
  const Motion& motion_;
  Pose mount_;
  std::int64_t start_ns_, packet_ns_;
  Random random_;
  Beam beam_;
  PlacedMovers movers_;
  Dust dust_;
  FixedVector<Echo> echoes_;
  std::array<Laser, velodyne::kLasers> lasers_{};
  std::array<SimulatedShot, kMostShots> shots_{};
  std::size_t shot_count_;
};

}  // namespace scree
