#include "scree/clock/delay_envelope.hpp"

#include <algorithm>

namespace scree {
namespace {

/// What is expected of the skew where nothing is known about it: crystals are good for 50 ppm.
constexpr std::int64_t kExpectedSkewPpb = 50'000;
/// Delays vary by this much even where few samples look alike.
constexpr std::int64_t kLeastNoise = 20'000;
/// A slope that is less certain than this counts for nothing.
constexpr std::int64_t kUselessSlopePpb = 10'000'000;

constexpr std::int64_t kWindow =
    DelayEnvelope::kLongestBucket * static_cast<std::int64_t>(DelayEnvelope::kBuckets);

constexpr std::int64_t slope_ns(std::int64_t x_us, std::int64_t ppb) {
  return x_us * ppb / 1'000'000;
}

}  // namespace

void DelayEnvelope::reset(const ClockSample& first) {
  known_skew_ppb_ = line_.skew_ppb;
  bucket_ns_ = kShortestBucket;
  samples_[0] = first;
  count_ = 1;
  fit();
}

void DelayEnvelope::add(const ClockSample& sample) {
  ClockSample& last = samples_[count_ - 1];
  if (sample.device_ns - last.device_ns >= kWindow) return reset(sample);
  const std::int64_t excess = excess_ns(sample);
  if (is_in_last_bucket(sample)) {
    if (excess >= excess_ns(last)) return;
    last = sample;
    if (excess < 0) fit();
  } else if (sample.device_ns > last.device_ns) {
    append(sample);
    fit();
  }
}

bool DelayEnvelope::is_in_last_bucket(const ClockSample& sample) const {
  return sample.device_ns / bucket_ns_ == samples_[count_ - 1].device_ns / bucket_ns_;
}

void DelayEnvelope::append(const ClockSample& sample) {
  std::size_t old = 0;
  while (old < count_ && sample.device_ns - samples_[old].device_ns >= kWindow) ++old;
  drop_first(old);
  while (count_ == kBuckets && bucket_ns_ < kLongestBucket) join_pairs();
  if (count_ == kBuckets) drop_first(1);
  samples_[count_++] = sample;
}

void DelayEnvelope::drop_first(std::size_t count) {
  std::copy(samples_.begin() + static_cast<std::ptrdiff_t>(count),
            samples_.begin() + static_cast<std::ptrdiff_t>(count_), samples_.begin());
  count_ -= count;
}

void DelayEnvelope::join_pairs() {
  bucket_ns_ *= 2;
  std::size_t kept = 0;
  for (std::size_t i = 1; i < count_; ++i) {
    const ClockSample& sample = samples_[i];
    ClockSample& before = samples_[kept];
    if (sample.device_ns / bucket_ns_ != before.device_ns / bucket_ns_) {
      samples_[++kept] = sample;
    } else if (excess_ns(sample) < excess_ns(before)) {
      before = sample;
    }
  }
  count_ = kept + 1;
}

void DelayEnvelope::fit() {
  const ClockSample& first = samples_[0];
  for (std::size_t i = 0; i < count_; ++i) {
    points_[i] = {(samples_[i].device_ns - first.device_ns) / 1000,
                  samples_[i].offset_ns - first.offset_ns};
  }
  // Each half of the samples has a corner of the hull, and the more buckets there are the closer
  // their best comes to no delay; so the noise of the slope falls with their number and their span.
  const std::int64_t slope = hull_slope_ppb();
  support(slope, usual_excess_ns_);
  const std::int64_t noise_ns = 8 * (usual_excess_ns_ + kLeastNoise) / buckets();
  const std::int64_t span_us = std::max<std::int64_t>(points_[count_ - 1].x_us, 1);
  const std::int64_t noise_ppb = std::min(noise_ns * 1'000'000 / span_us + 1, kUselessSlopePpb);

  constexpr std::int64_t kExpected = kExpectedSkewPpb * kExpectedSkewPpb;
  line_.skew_ppb =
      known_skew_ppb_ + (slope - known_skew_ppb_) * kExpected / (kExpected + noise_ppb * noise_ppb);
  line_.device_ns = first.device_ns;
  line_.offset_ns = first.offset_ns + support(line_.skew_ppb, usual_excess_ns_);
  accuracy_ns_ = noise_ns + slope_ns(span_us, std::min(noise_ppb, kExpectedSkewPpb)) / 2;
}

std::int64_t DelayEnvelope::hull_slope_ppb() const {
  if (count_ < 2) return known_skew_ppb_;
  // Andrew's monotone chain, the lower half of it.
  std::array<Point, kBuckets> hull;
  std::size_t corners = 0;
  std::int64_t sum_us = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Point& point = points_[i];
    sum_us += point.x_us;
    const auto bends_down = [&] {
      const Point &a = hull[corners - 2], &b = hull[corners - 1];
      return (b.x_us - a.x_us) * (point.y_ns - a.y_ns) <= (b.y_ns - a.y_ns) * (point.x_us - a.x_us);
    };
    while (corners >= 2 && bends_down()) --corners;
    hull[corners++] = point;
  }
  const std::int64_t mean_us = sum_us / buckets();
  std::size_t right = 1;
  while (right + 1 < corners && hull[right].x_us <= mean_us) ++right;
  if (hull[right].x_us == hull[right - 1].x_us) return known_skew_ppb_;
  const std::int64_t slope = (hull[right].y_ns - hull[right - 1].y_ns) * 1'000'000 /
                             (hull[right].x_us - hull[right - 1].x_us);
  return std::clamp(slope, -kMaxSkewPpb, kMaxSkewPpb);
}

std::int64_t DelayEnvelope::support(std::int64_t slope_ppb, std::int64_t& mean_excess_ns) const {
  std::int64_t least = 0, sum = 0;  // the first point is the origin
  for (std::size_t i = 0; i < count_; ++i) {
    const std::int64_t height = points_[i].y_ns - slope_ns(points_[i].x_us, slope_ppb);
    least = std::min(least, height);
    sum += height;
  }
  mean_excess_ns = sum / buckets() - least;
  return least;
}

}  // namespace scree
