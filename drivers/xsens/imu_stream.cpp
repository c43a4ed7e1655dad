#include "scree/drivers/xsens/imu_stream.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/xsens/orientation.hpp"

namespace scree::xsens {
namespace {

/// Messages this much older than the one before them were overtaken on the way (a capture may have
/// been cut together); older ones come from a device that started over.
constexpr int kMostLateMessages = 100;
constexpr std::int32_t kMostLateTicks = 10'000;

/// After this the packet counter may have wrapped: nothing is compared with what was before.
constexpr std::int64_t kLongestGap = 15 * kSecond;  // 2^15 messages at 2000 a second: 16 s

/// No MTi sends more messages in so long, and a burst of those that waited: a counter that went on
/// by more has started over, or is garbled.
std::int64_t most_messages(std::int64_t elapsed_ns) {
  constexpr std::int64_t kMostInSecond = 2000, kMostWaiting = 100;
  return kMostWaiting +
         std::clamp<std::int64_t>(elapsed_ns, 0, kLongestGap) * kMostInSecond / kSecond;
}

/// Increments over a longer time are no rate.
constexpr std::int64_t kLongestInterval = kSecond;

Eigen::Vector3d vector(const Vector3& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// The turn as a rotation vector, radians.
Eigen::Vector3d rotation_vector(const Quaternion& turn) {
  const Eigen::Vector3d axis(turn[1], turn[2], turn[3]);
  const double sine = axis.norm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  const double sign = turn[0] < 0 ? -1 : 1;
  return axis * (sign * 2 * std::atan2(sine, std::abs(turn[0])) / sine);
}

/// @param interval_ns that increments were summed over; 0 unknown
ImuSample to_sample(const Measurement& measurement, std::int64_t interval_ns) {
  ImuSample sample;
  if (const auto orientation = orientation_enu(measurement)) {
    sample.has_orientation = true;
    sample.orientation = *orientation;
  }
  const double interval = static_cast<double>(interval_ns) * 1e-9;
  sample.has_rate = true;
  if (measurement.rate_of_turn) {
    sample.rate = vector(*measurement.rate_of_turn);
  } else if (measurement.rate_of_turn_hr) {
    sample.rate = vector(*measurement.rate_of_turn_hr);
  } else if (measurement.delta_q && interval > 0) {
    sample.rate = rotation_vector(*measurement.delta_q) / interval;
  } else {
    sample.has_rate = false;
  }
  sample.has_acceleration = true;
  if (measurement.acceleration) {
    sample.acceleration = vector(*measurement.acceleration);
  } else if (measurement.acceleration_hr) {
    sample.acceleration = vector(*measurement.acceleration_hr);
  } else if (measurement.delta_v && interval > 0) {
    sample.acceleration = vector(*measurement.delta_v) / interval;
  } else {
    sample.has_acceleration = false;
  }
  return sample;
}

}  // namespace

std::uint64_t ImuCounters::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

ImuStream::ImuStream(const ImuSettings& settings, OnSample on_sample, OnMeasurement on_measurement)
    : on_sample_(std::move(on_sample)),
      on_measurement_(std::move(on_measurement)),
      clock_(settings.baud) {}

void ImuStream::take(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  framer_.take(bytes, [&](const Message& message) { take_message(message, arrival_ns); });
  update_counters();
}

void ImuStream::flush() {
  framer_.flush([&](const Message& message) { take_message(message, last_arrival_ns_); });
  update_counters();
}

void ImuStream::update_counters() {
  const FramingCounters& framing = framer_.counters();
  for (std::size_t i = 0; i < kRefusals; ++i) {
    counters_.refused[i] = refused_[i] + items_.refused[i];
  }
  counters_.refused[static_cast<std::size_t>(Refusal::checksum)] = framing.checksum;
  counters_.refused[static_cast<std::size_t>(Refusal::length)] = framing.length;
  counters_.unknown_items = items_.unknown;
  counters_.bytes_skipped = framing.bytes_skipped;
  counters_.device_restarts = clock_.device_restarts();
  counters_.host_steps = clock_.host_steps();
}

void ImuStream::take_message(const Message& message, std::int64_t arrival_ns) {
  if (message.id != MessageId::mt_data2) {
    ++counters_.other_messages;
    return;
  }
  const std::uint64_t decoded = items_.decoded;
  const Measurement measurement = decode_mt_data2(message.data, items_);
  if (items_.decoded == decoded) return refuse(Refusal::empty);
  // One in 256 garbled messages has a right checksum.
  if (!is_plausible(to_sample(measurement, 0))) return refuse(Refusal::implausible);
  const Refusal refusal = check_sequence(measurement, arrival_ns);
  if (refusal != Refusal::none) return refuse(refusal);
  last_arrival_ns_ = arrival_ns;
  ++counters_.accepted;

  const Arrival arrival{arrival_ns, message.size, message.bytes_behind};
  if (measurement.is_inertial()) return take_inertial(measurement, arrival);
  counters_.lost += static_cast<std::uint64_t>(missing_);
  increments_lost_ += missing_;
  if (on_measurement_) on_measurement_(clock_.host_time(measurement, arrival), measurement);
}

Refusal ImuStream::check_sequence(const Measurement& measurement, std::int64_t arrival_ns) {
  if (arrival_ns - last_arrival_ns_ > kLongestGap) {
    last_counter_.reset();
    last_tick_.reset();
  }
  missing_ = 0;
  if (const auto& counter = measurement.packet_counter) {
    if (last_counter_) {
      const auto step = static_cast<std::int16_t>(*counter - *last_counter_);
      if (step == 0) return Refusal::duplicate;
      if (step < 0 && step > -kMostLateMessages) return Refusal::late;
      missing_ = std::max(step - 1, 0);
      if (missing_ > most_messages(arrival_ns - last_arrival_ns_)) missing_ = 0;
    }
  } else if (measurement.sample_time_fine && measurement.is_inertial() && last_tick_) {
    const auto step = static_cast<std::int32_t>(*measurement.sample_time_fine - *last_tick_);
    if (step == 0) return Refusal::duplicate;
    if (step < 0 && step > -kMostLateTicks) return Refusal::late;
  }
  if (measurement.packet_counter) last_counter_ = measurement.packet_counter;
  if (measurement.is_inertial()) last_tick_ = measurement.sample_time_fine;
  return Refusal::none;
}

void ImuStream::take_inertial(const Measurement& measurement, const Arrival& arrival) {
  const SampleClock::Stamp stamp = clock_.stamp(measurement, 1 + missing_, arrival);
  const bool started_over = stamp.started_over && counters_.samples > 0;
  if (stamp.started_over) {
    missing_ = 0;  // the counter started over with the device, or who knows for how long it was off
    last_t_ns_.reset();
  }
  counters_.lost += static_cast<std::uint64_t>(missing_);
  const std::int64_t interval_ns = increment_interval(measurement, stamp.elapsed_ns);
  const std::int64_t t_ns = last_t_ns_ ? std::max(stamp.t_ns, *last_t_ns_ + 1) : stamp.t_ns;
  last_t_ns_ = t_ns;
  hand_out(measurement, t_ns, interval_ns, started_over);
}

std::int64_t ImuStream::increment_interval(const Measurement& measurement,
                                           std::int64_t elapsed_ns) {
  if (increment_ns_) *increment_ns_ += elapsed_ns;
  if (elapsed_ns == 0) increment_ns_.reset();
  increments_lost_ += missing_;
  const std::int64_t interval_ns = increment_ns_.value_or(0) / (1 + increments_lost_);
  if (measurement.delta_q || measurement.delta_v) {
    increment_ns_ = 0;
    increments_lost_ = 0;
  }
  return interval_ns <= kLongestInterval ? interval_ns : 0;
}

void ImuStream::hand_out(const Measurement& measurement, std::int64_t t_ns,
                         std::int64_t interval_ns, bool started_over) {
  if (on_measurement_) on_measurement_(t_ns, measurement);
  ImuSample sample = to_sample(measurement, interval_ns);
  if (!sample.has_orientation && !sample.has_rate && !sample.has_acceleration) return;
  sample.t_ns = t_ns;
  sample.started_over = started_over;
  ++counters_.samples;
  counters_.oriented += sample.has_orientation ? 1 : 0;
  const bool is_useful = counters_.oriented == 0 ? sample.has_rate : sample.has_orientation;
  counters_.useful += is_useful ? 1 : 0;
  if (on_sample_) on_sample_(sample);
}

}  // namespace scree::xsens
