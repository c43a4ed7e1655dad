#include "simulator/imu.hpp"

#include <algorithm>
#include <cmath>

#include "scree/core/gravity.hpp"

namespace scree {

SimulatedImu::SimulatedImu(const Motion& motion, const Pose& mount,
                           const SimulatedImuSettings& settings, std::int64_t start_ns,
                           std::uint64_t seed)
    : motion_(motion),
      mount_(mount),
      settings_(settings),
      start_ns_(start_ns),
      random_(seed, 0x1A0),
      first_counter_(static_cast<std::uint16_t>(random_.next())),
      first_tick_(static_cast<std::uint32_t>(random_.next())),
      gyro_bias_(settings.gyro_bias * normal()),
      acceleration_bias_(settings.acceleration_bias * normal()),
      tilt_(settings.tilt_error * normal().head<2>()),
      yaw_(settings.yaw_offset),
      yaw_rate_(settings.yaw_drift * random_.normal()) {}

Eigen::Vector3d SimulatedImu::normal() {
  const double x = random_.normal();
  const double y = random_.normal();
  return {x, y, random_.normal()};
}

Pose SimulatedImu::sensor(std::int64_t t_ns) const {
  return motion_.base(t_ns) * mount_;
}

void SimulatedImu::wander() {
  const double step = 1 / settings_.rate_hz;
  gyro_bias_ += settings_.gyro_walk * std::sqrt(step) * normal();
  const double kept = std::exp(-step / settings_.tilt_correlation);
  tilt_ = kept * tilt_ + settings_.tilt_error * std::sqrt(1 - kept * kept) * normal().head<2>();
  yaw_ += yaw_rate_ * step;
  yaw_rate_ += 0.1 * settings_.yaw_drift * std::sqrt(step) * random_.normal();
}

ImuMessage SimulatedImu::next() {
  const double interval = 1e9 / settings_.rate_hz / (1 + settings_.clock_skew);
  ImuMessage sample;
  sample.t_ns = start_ns_ + static_cast<std::int64_t>(static_cast<double>(samples_) * interval);
  sample.packet_counter = static_cast<std::uint16_t>(first_counter_ + samples_);
  const auto ticks =
      static_cast<double>(samples_) * 1e9 / settings_.rate_hz / static_cast<double>(xsens::kTickNs);
  sample.sample_time_fine = first_tick_ + static_cast<std::uint32_t>(std::lround(ticks));
  sample.has_orientation = settings_.has_orientation;
  sample.status = xsens::kSelftestPassed | xsens::kFilterValid;
  ++samples_;

  constexpr std::int64_t kStepNs = 2'500'000;
  constexpr double kStep = static_cast<double>(kStepNs) * 1e-9;
  const Pose before = sensor(sample.t_ns - kStepNs);
  const Pose now = sensor(sample.t_ns);
  const Pose after = sensor(sample.t_ns + kStepNs);
  const double speed = std::min((after.translation - before.translation).norm() / (2 * kStep), 1.5);
  const Eigen::AngleAxisd turned(before.rotation.conjugate() * after.rotation);
  const Eigen::Vector3d acceleration =
      (after.translation - 2 * now.translation + before.translation) / (kStep * kStep) +
      Eigen::Vector3d(0, 0, kGravity);

  wander();
  sample.rate_of_turn = turned.angle() / (2 * kStep) * turned.axis() + gyro_bias_ +
                        settings_.gyro_noise * normal() +
                        settings_.gyro_vibration * speed * normal();
  sample.acceleration = now.rotation.conjugate() * acceleration + acceleration_bias_ +
                        settings_.acceleration_noise * normal() +
                        settings_.acceleration_vibration * speed * normal();
  sample.orientation =
      from_roll_pitch_yaw(0, 0, yaw_) * from_roll_pitch_yaw(tilt_.x(), tilt_.y(), 0) * now.rotation;
  if (sample.orientation.w() < 0) sample.orientation.coeffs() *= -1;
  return sample;
}

ImuSample sample_of(const ImuMessage& message) {
  return {.t_ns = message.t_ns,
          .has_orientation = message.has_orientation,
          .has_rate = true,
          .has_acceleration = true,
          .orientation = message.orientation,
          .rate = message.rate_of_turn,
          .acceleration = message.acceleration};
}

}  // namespace scree
