#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "scoring/truth.hpp"
#include "scree/core/sweep.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "simulator/byte_noise.hpp"
#include "simulator/encoder.hpp"
#include "simulator/faults.hpp"
#include "simulator/imu.hpp"
#include "simulator/lidar.hpp"
#include "simulator/movers.hpp"
#include "simulator/robot.hpp"
#include "simulator/scene.hpp"
#include "simulator/visibility.hpp"

namespace scree {

struct CaptureSettings {
  std::uint64_t seed = 1;
  Scene scene = Scene::mixed;
  double seconds = 20;          ///< rounded to whole turns, at least one
  double speed = 0;             ///< mean while driving, m/s; 0: drawn from 0.4 to 1.6
  bool reverse = false;         ///< drives backwards for a stretch
  bool turns = false;           ///< stops for a while and turns on the spot
  bool at_rest = false;         ///< the robot stands level at the origin, the ground is level there
  double rate_hz = 10;          ///< turns of the lidar a second, 5 to 20
  bool dual = false;            ///< dual returns instead of the strongest
  bool pps = false;             ///< the lidar's clock is locked to GPS; else it runs free
  double imu_rate_hz = 100;     ///< 100 to 400
  bool imu_orientation = true;  ///< false: it sends rates and accelerations alone
  bool imu_bursts = false;      ///< a USB adapter hands the IMU's bytes on every 16 ms only
  double cell = 0.02;           ///< of the terrain's raster, metres
  double margin = 28;           ///< of terrain beyond the way, metres
  MoverCounts movers;           ///< those that find no way are left out
  Faults faults;
};

/// Host's time at which every drive begins: 28 August 2020, 11:02 UTC.
inline constexpr std::int64_t kDriveStartNs = 1598612520'000000000;
/// Seconds since then.
constexpr double since_start(std::int64_t t_ns) {
  return static_cast<double>(t_ns - kDriveStartNs) * 1e-9;
}

SimulatedLidarSettings draw_lidar(const CaptureSettings& settings, const LidarSettings& mounted);
SimulatedImuSettings draw_imu(const CaptureSettings& settings);
SimulatedEncoderSettings draw_encoder(const CaptureSettings& settings);

/// A robot on its way over a terrain, and what moves there; sensors and terrain are those of the
/// seed.
struct Drive {
  explicit Drive(const CaptureSettings& settings);

  CaptureSettings settings;
  Robot robot;
  Terrain terrain;
  Motion motion;
  std::vector<Mover> movers;
};

/// Tells sweeps apart and notes at the end of each what has been seen.
class Observer {
public:
  /// Keeps references to both.
  Observer(const Drive& drive, Truth& truth)
      : visibility_(drive.terrain, drive.movers), motion_(drive.motion), truth_(truth) {}

  void watch(const SimulatedLidar& lidar);
  /// Turns finished since the motor's zero.
  double turns() const { return turns_; }

private:
  Visibility visibility_;
  const Motion& motion_;
  Truth& truth_;
  double turns_ = 0;
  std::int64_t last_shot_ns_ = 0;
};

/// The sensors of a drive without the bytes between: sweeps and samples as good decoders and
/// perfect clocks would give them, less what faults take away. Only where the IMU's bytes are
/// corrupted do its samples go through them and their decoder.
class DriveFeed {
public:
  static constexpr Faults kNoFaults{.packet_loss = 0, .imu_gap = {}, .encoder_gap = {}};

  /// Keeps a reference to the drive.
  /// @param faults instead of those of the drive's settings
  explicit DriveFeed(const Drive& drive, const Faults& faults = kNoFaults);

  /// Fills the next sweep, and puts the samples that cover it into each buffer. False when the
  /// drive is over.
  bool next(Sweep& sweep, std::initializer_list<SyncBuffer*> sensors);
  /// What can be asked for after each sweep so far.
  const Truth& truth() const { return truth_; }

private:
  void feed_imu(std::int64_t t_ns, std::initializer_list<SyncBuffer*> sensors);
  void feed_encoder(std::int64_t t_ns, std::initializer_list<SyncBuffer*> sensors);

  const Drive& drive_;
  Faults faults_;
  Random losses_;
  RayCaster caster_;
  SimulatedLidar lidar_;
  SimulatedImu imu_;
  SimulatedEncoder encoder_;
  Truth truth_;
  Observer observer_;
  ImuMessage next_sample_;
  ByteNoise imu_noise_;
  std::vector<std::uint8_t> imu_bytes_;
  std::vector<ImuSample> decoded_;
  xsens::ImuStream imu_stream_;
  double encoder_gain_;  ///< of its scale's error
  std::int64_t encoder_ns_;
  double turns_ = 0;                               // handed out
  std::size_t shot_ = SimulatedLidar::kMostShots;  // the next of the packet
  bool is_lost_ = false;                           // the packet
  std::int64_t begin_ns_ = kDriveStartNs, last_ns_ = kDriveStartNs;
};

}  // namespace scree
