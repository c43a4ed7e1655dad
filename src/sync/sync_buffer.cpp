#include "scree/sync/sync_buffer.hpp"

#include <cmath>

#include "scree/core/rotation.hpp"

namespace scree {
namespace {

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-9;
}

/// Times of which any two can be subtracted.
bool is_time(std::int64_t t_ns) {
  constexpr std::int64_t kFarthest = std::int64_t{1} << 62;
  return t_ns > -kFarthest && t_ns < kFarthest;
}

bool is_sound(const ImuSample& sample) {
  constexpr double kUnit = 0.1;  // how far a quaternion's length may be from 1
  return is_time(sample.t_ns) && std::abs(sample.orientation.norm() - 1) < kUnit &&
         is_plausible(sample);
}

/// What was not sent is nought, whatever stands there.
void clear_absent(ImuSample& sample) {
  if (!sample.has_orientation) sample.orientation.setIdentity();
  if (!sample.has_rate) sample.rate.setZero();
  if (!sample.has_acceleration) sample.acceleration.setZero();
}

bool is_sound(const EncoderSample& sample) {
  constexpr double kFarthest = 1e9;  // metres: years of driving
  return is_time(sample.t_ns) && std::abs(sample.distance) < kFarthest;
}

/// Whether a wheel can have come from one to the other. Readings that were held up on the way come
/// with hardly any time between them.
bool can_follow(const EncoderSample& before, const EncoderSample& sample) {
  constexpr double kMostSpeed = 200;  // m/s, the largest encoder.max_speed
  const std::int64_t apart_ns = sample.t_ns - before.t_ns;
  if (apart_ns > SyncBuffer::kSilenceNs) return true;  // it begins anew
  const double longest = kMostSpeed * seconds(apart_ns + SyncBuffer::kSilenceNs);
  return std::abs(sample.distance - before.distance) <= longest;
}

/// Whether the clock was set back before this sample.
template <class Sample>
bool is_set_back(const SampleHistory<Sample>& history, const Sample& sample) {
  return !history.empty() && sample.t_ns < history.newest().t_ns - SyncBuffer::kSetBackNs;
}

/// Whether nothing follows the samples before `next`, or only after silence: then the answer must
/// not depend on whether that has come already.
template <class Sample>
bool ends_at(const SampleHistory<Sample>& history, std::size_t next) {
  return next == history.size() ||
         history[next].t_ns - history[next - 1].t_ns > SyncBuffer::kSilenceNs;
}

/// Where the device sends no rate: that between two of its orientations, sensor axes.
Eigen::Vector3d mean_rate(const ImuSample& before, const ImuSample& after) {
  return logarithm(before.orientation.conjugate() * after.orientation) /
         seconds(after.t_ns - before.t_ns);
}

}  // namespace

template <class Sample>
bool SyncBuffer::put(const Sample& sample, Ring<Sample>& ring) {
  if (ring.samples.write_available() == 0) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  ring.depth.put();
  return ring.samples.push(sample);
}

bool SyncBuffer::put(const ImuSample& sample) {
  return put(sample, imu_ring_);
}

bool SyncBuffer::put(const EncoderSample& sample) {
  return put(sample, wheel_ring_);
}

bool SyncBuffer::accept(ImuSample sample) {
  clear_absent(sample);
  if (!is_sound(sample)) return false;
  sample.t_ns -= delays_.imu_ns;
  if (sample.started_over) imu_restart_ns_ = sample.t_ns;
  if (is_set_back(imu_, sample)) {
    imu_.clear();
    attitude_.restart();
    heading_.restart();
  }
  if (!attitude_.complete(sample, [this](std::int64_t t_ns) { return mean_speed(t_ns); })) {
    return true;
  }
  heading_.correct(sample);
  return imu_.push(sample);
}

bool SyncBuffer::accept(EncoderSample sample) {
  if (!is_sound(sample)) return false;
  sample.t_ns -= delays_.wheel_ns;
  if (is_set_back(wheel_, sample)) wheel_.clear();
  if (!wheel_.empty() && !can_follow(wheel_.newest(), sample)) return false;
  return wheel_.push(sample);
}

/// The wheel's speed about an instant: a counter's steps are coarse.
std::optional<double> SyncBuffer::mean_speed(std::int64_t t_ns) const {
  constexpr std::int64_t kAbout = 75'000'000;
  const auto before = wheel_at(t_ns - kAbout), after = wheel_at(t_ns + kAbout);
  if (!before || !after) return std::nullopt;
  return (after->distance - before->distance) / seconds(2 * kAbout);
}

/// Moves a ring's samples into the history. @return how many of them it refused
template <class Sample>
std::uint64_t SyncBuffer::drain(Ring<Sample>& ring) {
  std::uint64_t refused = 0;
  ring.samples.consume_all([&](const Sample& sample) {
    ring.depth.take();
    refused += accept(sample) ? 0 : 1;
  });
  return refused;
}

void SyncBuffer::gather() {
  late_.fetch_add(drain(wheel_ring_), std::memory_order_relaxed);
  late_.fetch_add(drain(imu_ring_), std::memory_order_relaxed);
}

bool SyncBuffer::covers(std::int64_t t_ns) const {
  const auto covered = [t_ns](const auto& history, std::int64_t delay_ns) {
    if (history.empty()) return true;
    const std::int64_t newest_ns = history.newest().t_ns;
    return newest_ns >= t_ns || newest_ns + delay_ns < t_ns - kSilenceNs;
  };
  return covered(imu_, delays_.imu_ns) && covered(wheel_, delays_.wheel_ns);
}

std::optional<Attitude> SyncBuffer::attitude_at(std::int64_t t_ns) const {
  const std::size_t next = imu_.count_until(t_ns);
  if (next == 0) return std::nullopt;
  const ImuSample& before = imu_[next - 1];
  if (ends_at(imu_, next)) {
    const double beyond = seconds(t_ns - before.t_ns);
    if (t_ns - before.t_ns > kSilenceNs) return std::nullopt;
    const Eigen::Vector3d rate =
        before.has_rate || next < 2 ? before.rate : mean_rate(imu_[next - 2], before);
    return Attitude{before.orientation * exponential(rate * beyond), rate};
  }
  const ImuSample& after = imu_[next];
  const double share = seconds(t_ns - before.t_ns) / seconds(after.t_ns - before.t_ns);
  const Eigen::Vector3d rate = before.has_rate && after.has_rate
                                   ? before.rate + share * (after.rate - before.rate)
                                   : mean_rate(before, after);
  return Attitude{before.orientation.slerp(share, after.orientation), rate};
}

std::optional<WheelMotion> SyncBuffer::wheel_at(std::int64_t t_ns) const {
  const std::size_t next = wheel_.count_until(t_ns);
  if (next == 0) return std::nullopt;
  const EncoderSample& before = wheel_[next - 1];
  const auto speed = [](const EncoderSample& a, const EncoderSample& b) {
    return (b.distance - a.distance) / seconds(b.t_ns - a.t_ns);
  };
  if (ends_at(wheel_, next)) {
    if (t_ns - before.t_ns > kSilenceNs) return std::nullopt;
    // The speed is that over several samples, because a counter's steps are coarse.
    const std::size_t back = next >= 5 ? next - 5 : 0;
    const double last = back + 1 < next ? speed(wheel_[back], before) : 0;
    return WheelMotion{before.distance + last * seconds(t_ns - before.t_ns), last};
  }
  const EncoderSample& after = wheel_[next];
  const double between = speed(before, after);
  return WheelMotion{before.distance + between * seconds(t_ns - before.t_ns), between};
}

}  // namespace scree
