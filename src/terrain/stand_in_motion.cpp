#include "scree/terrain/stand_in_motion.hpp"

#include <algorithm>

#include "scree/core/rotation.hpp"
#include "scree/motion/ground_plane.hpp"

namespace scree {
namespace {

/// Swings within a sweep are seen only on the whole. With less, simulated drives have ghosts 8 m
/// off.
constexpr double kAttitudeWalk = 0.03;  // rad in a square root of a second

}  // namespace

StandInMotion::StandInMotion(const Settings& settings)
    : mount_(settings.lidar.mount()),
      imu_mount_(settings.imu.mount().rotation),
      wheel_place_(settings.encoder.translation),
      samples_(imu_mount_, {}, kAttitudeWalk) {}

/// On the whole the ground around a robot is level, or slopes so that it makes no difference.
void StandInMotion::begin(const LidarOdometry& odometry) {
  has_begun_ = true;
  const auto around = fit_ground_around(odometry.sweep().points);
  if (!around) return;
  attitude_ = Eigen::Quaterniond::FromTwoVectors(mount_.rotation * around->normal,
                                                 Eigen::Vector3d::UnitZ());
}

void StandInMotion::put(const Eigen::Quaterniond& attitude, const Eigen::Vector3d& rate,
                        double distance, std::int64_t t_ns) {
  ImuSample imu;
  imu.t_ns = t_ns;
  imu.has_orientation = imu.has_rate = true;
  imu.orientation = attitude * imu_mount_;
  imu.rate = imu_mount_.conjugate() * rate;
  EncoderSample wheel;
  wheel.t_ns = t_ns;
  wheel.distance = distance;
  samples_.put(imu);
  samples_.put(wheel);
}

void StandInMotion::add(const LidarOdometry& odometry, bool follows, const SyncBuffer& sensors) {
  constexpr std::int64_t kApart = SyncBuffer::kSilenceNs / 3;
  constexpr std::int64_t kBoundNs = 1'000'000'000;  // so long what is bound no more is believed
  if (!has_begun_) begin(odometry);
  const std::int64_t begin_ns = odometry.begin_ns(), end_ns = odometry.end_ns();
  const bool is_bound_now = follows && odometry.is_bound();
  settles_ = is_bound_now && !is_settled_;
  is_settled_ = follows && (is_settled_ || is_bound_now);
  if (!follows || is_bound_now) bound_ns_ = end_ns;
  is_bound_ = end_ns - bound_ns_ < kBoundNs;
  if (!follows) {
    put(attitude_, Eigen::Vector3d::Zero(), distance_, end_ns);
    samples_.gather();
    return;
  }
  const Pose step = mount_ * odometry.step() * mount_.inverse();
  const Eigen::Vector3d turn = logarithm(step.rotation);
  const double seconds = static_cast<double>(end_ns - begin_ns) * 1e-9;
  const auto wheel_begin = sensors.wheel_at(begin_ns), wheel_end = sensors.wheel_at(end_ns);
  // Along x as it is half the way, as DeadReckoning lays a wheel's way.
  const double way = wheel_begin && wheel_end ? wheel_end->distance - wheel_begin->distance
                                              : (exponential(-turn / 2) * step.translation).x() +
                                                    turn.cross(wheel_place_).x();
  const std::int64_t samples = std::max<std::int64_t>((end_ns - begin_ns + kApart - 1) / kApart, 1);
  for (std::int64_t i = 1; i <= samples; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(samples);
    put((attitude_ * exponential(turn * share)).normalized(), turn / seconds,
        distance_ + share * way, begin_ns + (end_ns - begin_ns) * i / samples);
  }
  attitude_ = (attitude_ * step.rotation).normalized();
  distance_ += way;
  samples_.gather();
}

}  // namespace scree
