#pragma once

#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>

#include "scree/core/encoder_sample.hpp"
#include "scree/core/imu_sample.hpp"
#include "scree/core/queue_depth.hpp"
#include "scree/sync/attitude_filter.hpp"
#include "scree/sync/heading_jump_filter.hpp"
#include "scree/sync/sample_history.hpp"

namespace scree {

/// Attitude of the IMU between, or a little beyond, its samples.
struct Attitude {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< see ImuSample::orientation
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();                ///< rad/s, sensor axes
};

/// Way of the wheel between, or a little beyond, its samples.
struct WheelMotion {
  double distance = 0;  ///< metres, see EncoderSample
  double speed = 0;     ///< m/s
};

/// By how much longer than the lidar's the messages of a sensor take to the host.
struct SampleDelays {
  std::int64_t imu_ns = 0, wheel_ns = 0;
};

/// The timestamp-synchronised ring buffer: samples of the IMU and of the encoder come in from one
/// thread each, and the detector's thread asks for the motion at any instant. Bounded: a producer
/// whose ring is full drops the new sample, and history forgets the oldest. No locks, and no memory
/// taken after construction.
class SyncBuffer {
public:
  /// A sensor's two samples around an instant may lie this far apart; and the last one may lie this
  /// long ago. Beyond it the sensor was silent. An encoder may send as little as 10 frames a
  /// second, and not on the dot.
  static constexpr std::int64_t kSilenceNs = 150'000'000;
  /// A sample this much older than the one before says that the clock was set back: what came
  /// before is forgotten.
  static constexpr std::int64_t kSetBackNs = 1'000'000'000;

  /// @param imu_mount rotation imu -> base
  /// @param delays by which the samples that are put are too late
  /// @param attitude_walk see there
  explicit SyncBuffer(const Eigen::Quaterniond& imu_mount = Eigen::Quaterniond::Identity(),
                      const SampleDelays& delays = {}, double attitude_walk = 0)
      : delays_(delays), attitude_(imu_mount), attitude_walk_(attitude_walk) {}

  // Producers, one thread each. False: no room, dropped and counted.
  bool put(const ImuSample& sample);
  bool put(const EncoderSample& sample);

  // The consumer.

  /// Takes over what the producers have put. Refused: samples not newer than those before, and
  /// those with values that are no numbers or implausible. Passed over: those of the IMU that
  /// AttitudeFilter gives no orientation, as samples of high rate.
  void gather();
  /// Whether waiting longer cannot give the motion until t_ns any better: each sensor has a sample
  /// from then or later, or has been silent for kSilenceNs before it.
  bool covers(std::int64_t t_ns) const;
  bool has_motion() const { return !imu_.empty() || !wheel_.empty(); }

  /// Interpolated (slerp), or carried on with the last rate for less than kSilenceNs. Nothing:
  /// silent then, or too long ago.
  std::optional<Attitude> attitude_at(std::int64_t t_ns) const;
  std::optional<WheelMotion> wheel_at(std::int64_t t_ns) const;

  /// The IMU's, with orientations of AttitudeFilter where it sends none, and with a yaw that
  /// HeadingJumpFilter keeps.
  const SampleHistory<ImuSample>& imu() const { return imu_; }
  const SampleHistory<EncoderSample>& wheel() const { return wheel_; }
  const HeadingJumpFilter& heading() const { return heading_; }
  /// When the IMU last started over while it was listened to; 0: never.
  std::int64_t imu_restart_ns() const { return imu_restart_ns_; }
  /// How much more than those of an IMU the turns between its attitudes err: standard deviation,
  /// rad in a square root of a second.
  double attitude_walk() const {
    return attitude_.answers() ? AttitudeFilter::kWalk : attitude_walk_;
  }
  /// Samples that found no room, and samples that gather() refused. Any thread.
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  std::uint64_t late() const { return late_.load(std::memory_order_relaxed); }
  /// How full the rings are that the producers fill and gather() empties. Any thread.
  QueueFill imu_fill() const { return imu_ring_.depth.fill(); }
  QueueFill wheel_fill() const { return wheel_ring_.depth.fill(); }

private:
  static constexpr std::size_t kRing = 4096;  // over 4 s at 1 kHz
  static constexpr std::size_t kHistory = 4096;

  template <class Sample>
  struct Ring {
    boost::lockfree::spsc_queue<Sample, boost::lockfree::capacity<kRing>> samples;
    QueueDepth depth{kRing};
  };

  template <class Sample>
  bool put(const Sample& sample, Ring<Sample>& ring);
  template <class Sample>
  std::uint64_t drain(Ring<Sample>& ring);
  bool accept(ImuSample sample);
  bool accept(EncoderSample sample);
  std::optional<double> mean_speed(std::int64_t t_ns) const;

  SampleDelays delays_;
  Ring<ImuSample> imu_ring_;
  Ring<EncoderSample> wheel_ring_;
  SampleHistory<ImuSample> imu_{kHistory};
  SampleHistory<EncoderSample> wheel_{kHistory};
  AttitudeFilter attitude_;
  double attitude_walk_;
  HeadingJumpFilter heading_;
  std::int64_t imu_restart_ns_ = 0;
  std::atomic<std::uint64_t> dropped_{0}, late_{0};
};

}  // namespace scree
