#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "scree/clock/clock_line.hpp"

namespace scree {

/// The line below all samples of the last minute: what packets of the least delay would give.
///
/// A packet cannot arrive before it was sent, and now and then one arrives with next to no delay.
/// So the samples lie on and above a line, and the edge of their lower convex hull that passes
/// below their mean device time is the line below all of them that is closest to them (Moon, Skelly
/// and Towsley, "Estimation and removal of clock skew from network delay measurements", 1999).
///
/// Each bucket, a stretch of time, keeps only its sample of least delay. Buckets are short at first
/// and get longer until kBuckets of them make a minute, so that the first second is resolved too.
///
/// A slope over a short time is the noise's. It is weighed by what the delays let expect of it
/// against the slope known before: 0 with 50 ppm at first, and after reset() what it was.
class DelayEnvelope {
public:
  static constexpr std::size_t kBuckets = 64;
  static constexpr std::int64_t kShortestBucket = 15'625'000, kLongestBucket = 1'000'000'000;
  static constexpr std::int64_t kMaxSkewPpb = 200'000;

  /// Forgets all samples but keeps the skew, as the crystals stay the same.
  void reset(const ClockSample& first);
  /// Takes a sample; one older than the present bucket tells nothing and is left out.
  void add(const ClockSample& sample);

  /// @pre reset() was called
  const ClockLine& line() const { return line_; }
  /// How far a sample lies above the line.
  std::int64_t excess_ns(const ClockSample& sample) const {
    return sample.offset_ns - line_.offset_at(sample.device_ns);
  }
  /// The buckets' mean excess: what delay is usual even for the most prompt of them.
  std::int64_t usual_excess_ns() const { return usual_excess_ns_; }
  /// How far off the line may be at its newest end.
  std::int64_t accuracy_ns() const { return accuracy_ns_; }

private:
  /// A bucket's sample relative to the first one's: microseconds and nanoseconds, whose products
  /// do not overflow.
  struct Point {
    std::int64_t x_us, y_ns;
  };

  /// Never 0: something to divide by.
  std::int64_t buckets() const {
    return static_cast<std::int64_t>(std::max<std::size_t>(count_, 1));
  }
  bool is_in_last_bucket(const ClockSample& sample) const;
  void append(const ClockSample& sample);
  void join_pairs();
  void drop_first(std::size_t count);
  void fit();
  std::int64_t hull_slope_ppb() const;
  /// Least y above a slope through the origin, and the mean of y above that.
  std::int64_t support(std::int64_t slope_ppb, std::int64_t& mean_excess_ns) const;

  std::array<ClockSample, kBuckets> samples_{};  ///< the buckets', in the order of time
  std::array<Point, kBuckets> points_{};         ///< the same while a line is fitted
  std::size_t count_ = 0;
  std::int64_t bucket_ns_ = kShortestBucket;
  ClockLine line_;
  std::int64_t known_skew_ppb_ = 0;
  std::int64_t usual_excess_ns_ = 0, accuracy_ns_ = 0;
};

}  // namespace scree
