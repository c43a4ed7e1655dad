#include "scree/motion/dead_reckoning.hpp"

#include <algorithm>

#include "scree/core/rotation.hpp"

namespace scree {

MotionTrack::Place MotionTrack::at(std::int64_t before_end_ns) const {
  const float step = static_cast<float>(before_end_ns) / static_cast<float>(step_ns_);
  const auto index = static_cast<std::size_t>(std::max(step, 0.0F));
  if (index + 1 >= places_.size()) return places_.back();
  const float share = step - static_cast<float>(index);
  const Place& late = places_[index];
  const Place& early = places_[index + 1];
  // Between places 5 ms apart the turn is so small that the matrices may be mixed.
  return {late.rotation + share * (early.rotation - late.rotation),
          late.translation + share * (early.translation - late.translation)};
}

/// Turns all of the step under way: its path stays as it is.
void DeadReckoning::turn(const Eigen::Quaterniond& rotation) {
  const auto turned = [&rotation](State& state) {
    state.attitude = (rotation * state.attitude).normalized();
    state.position = rotation * state.position;
  };
  turned(state_);
  turned(begin_);
  for (State& state : states_) turned(state);
}

void DeadReckoning::go_on(const SyncBuffer& sensors, std::int64_t t_ns) {
  const double seconds = static_cast<double>(t_ns - now_ns_) * 1e-9;
  const auto attitude = sensors.attitude_at(t_ns);
  const Eigen::Quaterniond guess = (state_.attitude * exponential(rate_ * seconds)).normalized();
  const Eigen::Quaterniond seen =
      attitude ? (attitude->rotation * imu_mount_.conjugate()).normalized() : guess;
  if (attitude) {
    if (!state_.knows_attitude) turn(seen * guess.conjugate());
    rate_ = imu_mount_ * attitude->rate;
  }
  State next = state_;
  next.attitude = seen;
  next.knows_attitude = attitude.has_value();
  const auto wheel = trusts_wheel_ ? sensors.wheel_at(t_ns) : std::nullopt;
  next.knows_distance = wheel.has_value();
  double moved = speed_ * seconds;
  if (wheel) {
    // A wheel that was silent begins anew: what it rolled meanwhile has been guessed already.
    moved = state_.knows_distance ? wheel->distance - wheel_ : wheel->speed * seconds;
    wheel_ = wheel->distance;
    speed_ = wheel->speed;
  }
  next.position += state_.attitude.slerp(0.5, next.attitude) * Eigen::Vector3d(moved, 0, 0);
  distance_ += moved;
  state_ = next;
  now_ns_ = t_ns;
}

MotionStep DeadReckoning::advance(const SyncBuffer& sensors, std::int64_t begin_ns,
                                  std::int64_t end_ns, MotionTrack& track, bool trusts_wheel) {
  trusts_wheel_ = trusts_wheel;
  MotionStep step;
  states_.clear();
  state_.position.setZero();
  begin_ = state_;
  distance_ = 0;
  begin_ns = std::min(begin_ns, end_ns);
  const bool was_away = started_ && end_ns - now_ns_ > kLongestWaitNs;
  step.begin_ns = now_ns_;
  step.end_ns = end_ns;
  if (!started_ || was_away || end_ns <= now_ns_) {
    step.begin_ns = was_away ? begin_ns - kLongestWaitNs : begin_ns;
    now_ns_ = begin_ns;
    go_on(sensors, begin_ns);
    started_ = true;
  }

  // The last part in equal steps, for the track; a long wait before it in coarser ones.
  constexpr std::int64_t kStep = MotionTrack::kLongestStepNs;
  constexpr std::int64_t kTracked = static_cast<std::int64_t>(MotionTrack::kMostSteps) * kStep;
  while (end_ns - now_ns_ > kTracked) {
    go_on(sensors, std::min(now_ns_ + 4 * kStep, end_ns - kTracked));
  }
  const std::int64_t tracked_ns = std::max<std::int64_t>(end_ns - now_ns_, 0);
  const std::int64_t steps = std::max<std::int64_t>((tracked_ns + kStep - 1) / kStep, 1);
  const std::int64_t from_ns = now_ns_;
  states_.push_back(state_);
  for (std::int64_t i = 1; i <= steps; ++i) {
    go_on(sensors, from_ns + tracked_ns * i / steps);
    states_.push_back(state_);
  }

  step.begin_attitude = begin_.attitude;
  step.attitude = state_.attitude;
  step.moved = state_.position;
  step.distance = distance_;
  step.knows_attitude = state_.knows_attitude;
  step.knows_distance = state_.knows_distance;

  track.start(std::max<std::int64_t>(tracked_ns / steps, 1));
  const Eigen::Quaterniond to_base = state_.attitude.conjugate();
  for (std::size_t i = states_.size(); i-- > 0;) {
    track.push_back({(to_base * states_[i].attitude).toRotationMatrix().cast<float>(),
                     (to_base * (states_[i].position - state_.position)).cast<float>()});
  }
  return step;
}

}  // namespace scree
