#include "scree/motion/dead_reckoning.hpp"

#include <algorithm>

#include "scree/core/rotation.hpp"

namespace scree {

/// Rotates the whole step under way: its path keeps its shape.
void DeadReckoning::rotate_step(const Eigen::Quaterniond& rotation) {
  const auto rotate = [&rotation](State& state) {
    state.attitude = (rotation * state.attitude).normalized();
    state.position = rotation * state.position;
  };
  rotate(state_);
  rotate(begin_);
  for (State& state : states_) rotate(state);
}

void DeadReckoning::integrate_to(const SyncBuffer& sensors, std::int64_t t_ns) {
  const double seconds = static_cast<double>(t_ns - now_ns_) * 1e-9;
  const auto attitude = sensors.attitude_at(t_ns);
  const Eigen::Quaterniond extrapolated =
      (state_.attitude * exponential(rate_ * seconds)).normalized();
  const Eigen::Quaterniond measured =
      attitude ? (attitude->rotation * imu_mount_.conjugate()).normalized() : extrapolated;
  if (attitude) {
    if (!state_.knows_attitude) rotate_step(measured * extrapolated.conjugate());
    rate_ = imu_mount_ * attitude->rate;
  }
  State next = state_;
  next.attitude = measured;
  next.knows_attitude = attitude.has_value();
  const auto wheel = trusts_wheel_ ? sensors.wheel_at(t_ns) : std::nullopt;
  next.knows_distance = wheel.has_value();
  double moved = speed_ * seconds;
  if (wheel) {
    // A wheel that was silent begins anew: what it rolled meanwhile is extrapolated already.
    moved = state_.knows_distance ? wheel->distance - wheel_ : wheel->speed * seconds;
    moved -= logarithm(state_.attitude.conjugate() * measured).cross(wheel_place_).x();
    wheel_ = wheel->distance;
    speed_ = wheel->speed - rate_.cross(wheel_place_).x();
  }
  next.position += state_.attitude.slerp(0.5, next.attitude) * Eigen::Vector3d(moved, 0, 0);
  distance_ += moved;
  state_ = next;
  now_ns_ = t_ns;
}

/// @return when the step begins
std::int64_t DeadReckoning::begin_step(const SyncBuffer& sensors, std::int64_t begin_ns,
                                       std::int64_t end_ns) {
  states_.clear();
  state_.position.setZero();
  begin_ = state_;
  distance_ = 0;
  const bool was_away = started_ && end_ns - now_ns_ > kLongestWaitNs;
  if (started_ && !was_away && end_ns > now_ns_) return now_ns_;
  begin_ns = std::min(begin_ns, end_ns);
  now_ns_ = begin_ns;
  integrate_to(sensors, begin_ns);
  started_ = true;
  return was_away ? begin_ns - kLongestWaitNs : begin_ns;
}

/// The last part goes in equal steps, for the trajectory; a long wait before it in coarser ones.
/// @return how long a step of the last part is
std::int64_t DeadReckoning::integrate_step(const SyncBuffer& sensors, std::int64_t end_ns) {
  constexpr std::int64_t kStep = SweepTrajectory::kLongestStepNs;
  constexpr std::int64_t kTracked = static_cast<std::int64_t>(SweepTrajectory::kMaxSteps) * kStep;
  while (end_ns - now_ns_ > kTracked) {
    integrate_to(sensors, std::min(now_ns_ + 4 * kStep, end_ns - kTracked));
  }
  const std::int64_t tracked_ns = std::max<std::int64_t>(end_ns - now_ns_, 0);
  const std::int64_t steps = std::max<std::int64_t>((tracked_ns + kStep - 1) / kStep, 1);
  const std::int64_t from_ns = now_ns_;
  states_.push_back(state_);
  for (std::int64_t i = 1; i <= steps; ++i) {
    integrate_to(sensors, from_ns + tracked_ns * i / steps);
    states_.push_back(state_);
  }
  return std::max<std::int64_t>(tracked_ns / steps, 1);
}

void DeadReckoning::write(SweepTrajectory& trajectory, std::int64_t step_ns) const {
  trajectory.start(step_ns);
  const Eigen::Quaterniond to_base = state_.attitude.conjugate();
  for (std::size_t i = states_.size(); i-- > 0;) {
    trajectory.push_back({(to_base * states_[i].attitude).toRotationMatrix().cast<float>(),
                          (to_base * (states_[i].position - state_.position)).cast<float>()});
  }
}

void DeadReckoning::restart() {
  state_ = begin_ = {};
  states_.clear();
  now_ns_ = 0;
  wheel_ = distance_ = speed_ = 0;
  rate_.setZero();
  started_ = false;
}

MotionStep DeadReckoning::advance(const SyncBuffer& sensors, std::int64_t begin_ns,
                                  std::int64_t end_ns, SweepTrajectory& trajectory,
                                  bool trusts_wheel) {
  trusts_wheel_ = trusts_wheel;
  MotionStep step;
  step.begin_ns = begin_step(sensors, begin_ns, end_ns);
  step.end_ns = end_ns;
  const std::int64_t step_ns = integrate_step(sensors, end_ns);
  step.begin_attitude = begin_.attitude;
  step.attitude = state_.attitude;
  step.displacement = state_.position;
  step.distance = distance_;
  step.knows_attitude = state_.knows_attitude;
  step.knows_distance = state_.knows_distance;
  step.attitude_walk = sensors.attitude_walk();
  write(trajectory, step_ns);
  return step;
}

}  // namespace scree
