#include "scree/drivers/xsens/sample_clock.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "scree/core/nanoseconds.hpp"

namespace scree::xsens {
namespace {

constexpr std::int64_t kDay = 86'400 * kSecond;

/// After this long without the better device time a worse one is taken up.
constexpr std::int64_t kMissing = kSecond;

/// Output rates that the manuals name, Hz.
constexpr std::array kUsualRates = {1,  2,   4,   5,   10,  20,  25,   40,   50,
                                    80, 100, 200, 400, 500, 800, 1000, 1600, 2000};
/// A rate is measured over this long, and is a usual one when it is this close to it.
constexpr std::int64_t kMeasureFor = 2 * kSecond;
constexpr double kRateTolerance = 0.02;

constexpr std::int64_t period_of(bool is_fine) {
  return is_fine ? kTickPeriodNs : kDay;
}

/// Within a day.
std::optional<std::int64_t> day_time(const UtcTime& utc) {
  using namespace std::chrono;
  if (utc.hour > 23 || utc.minute > 59 || utc.second > 60) return std::nullopt;
  const auto time =
      hours(utc.hour) + minutes(utc.minute) + seconds(utc.second) + nanoseconds(utc.nanosecond);
  return duration_cast<nanoseconds>(time).count() % kDay;
}

std::int64_t usual_period(double hertz) {
  for (const int rate : kUsualRates) {
    if (std::abs(hertz - rate) < kRateTolerance * rate) return kSecond / rate;
  }
  return 0;
}

}  // namespace

SampleClock::SampleClock(int baud) : byte_ns_(1e10 / baud), clock_(kTickPeriodNs) {}

SampleClock::Source SampleClock::best_source(const Measurement& message, bool is_counted) {
  if (message.sample_time_fine) return Source::fine;
  if (message.utc_time && day_time(*message.utc_time)) return Source::utc;
  return is_counted ? Source::counter : Source::arrival;
}

std::optional<std::int64_t> SampleClock::device_time(const Measurement& message,
                                                     Source source) const {
  switch (source) {
    case Source::fine:
      if (!message.sample_time_fine) return std::nullopt;
      return std::int64_t{*message.sample_time_fine} * kTickNs;
    case Source::utc:
      if (!message.utc_time) return std::nullopt;
      return day_time(*message.utc_time);
    case Source::counter:
      return samples_ * period_ns_ % kDay;
    case Source::arrival:
      break;
  }
  return std::nullopt;
}

void SampleClock::take_up(Source source) {
  restarts_before_ += clock_.device_restarts();
  steps_before_ += clock_.host_steps();
  clock_ = DeviceClock(period_of(source == Source::fine));
  source_ = source;
  started_ = false;
}

void SampleClock::count(std::int64_t step, std::int64_t arrival_ns) {
  // After a silence it may be another device, or set up otherwise.
  if (samples_ == 0 || std::abs(arrival_ns - counted_ns_) > kMissing) {
    samples_ = 0;
    period_ns_ = 0;
    counted_since_ns_ = arrival_ns;
  }
  counted_ns_ = arrival_ns;
  samples_ += step;
  const std::int64_t elapsed = arrival_ns - counted_since_ns_;
  if (period_ns_ != 0 || elapsed < kMeasureFor) return;
  period_ns_ = usual_period(static_cast<double>(samples_ - 1) * 1e9 / static_cast<double>(elapsed));
  if (period_ns_ == 0) samples_ = 0;
}

SampleClock::Stamp SampleClock::stamp(const Measurement& sample, std::int64_t step,
                                      const Arrival& arrival) {
  const bool has_counter = sample.packet_counter.has_value();
  if (has_counter) count(step, arrival.arrival_ns);
  const Source best = best_source(sample, has_counter && period_ns_ != 0);
  if (best > source_ || (best < source_ && arrival.arrival_ns - source_seen_ns_ > kMissing)) {
    take_up(best);
  }
  const auto device_ns = device_time(sample, source_);
  if (!device_ns) return {arrival.arrival_ns, 0, false};
  source_seen_ns_ = arrival.arrival_ns;

  const auto bytes_ns = [&](std::size_t bytes) {
    return std::llround(static_cast<double>(bytes) * byte_ns_);
  };
  const std::int64_t period_ns = period_of(source_ == Source::fine);
  const std::int64_t sent_ns = (*device_ns + bytes_ns(arrival.size)) % period_ns;
  const bool is_last = arrival.bytes_behind < arrival.size;
  const std::int64_t received_ns =
      arrival.arrival_ns - (is_last ? bytes_ns(arrival.bytes_behind) : 0);

  Stamp stamp;
  stamp.started_over = clock_.update(sent_ns, received_ns);
  stamp.t_ns = clock_.to_host(*device_ns);
  if (started_ && !stamp.started_over) {
    stamp.elapsed_ns = (*device_ns - last_device_ns_ + period_ns) % period_ns;
    if (stamp.elapsed_ns > period_ns / 2) stamp.elapsed_ns = 0;
  }
  last_device_ns_ = *device_ns;
  started_ = true;
  return stamp;
}

std::int64_t SampleClock::host_time(const Measurement& message, const Arrival& arrival) const {
  if (!started_ || source_ == Source::counter) return arrival.arrival_ns;
  const auto device_ns = device_time(message, source_);
  return device_ns ? clock_.to_host(*device_ns) : arrival.arrival_ns;
}

}  // namespace scree::xsens
