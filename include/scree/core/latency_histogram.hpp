#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace scree {

/// Durations counted in log-spaced buckets of fixed memory (15 kB): 32 buckets to each doubling, so
/// a quantile is at most 1/32 above the exact one. Recording takes constant time.
class LatencyHistogram {
public:
  /// Durations below zero (the host's clock was set back meanwhile) count as zero.
  void record(std::int64_t duration_ns) {
    const std::uint64_t value = duration_ns > 0 ? static_cast<std::uint64_t>(duration_ns) : 0;
    ++buckets_[index_of(value)];
    ++count_;
    max_ = std::max(max_, value);
  }

  std::uint64_t count() const { return count_; }
  std::int64_t max_ns() const { return static_cast<std::int64_t>(max_); }

  /// The least duration that at least this share of all durations does not exceed; 0 when empty.
  /// @pre 0 <= share <= 1
  std::int64_t quantile_ns(double share) const {
    const double wanted = std::ceil(share * static_cast<double>(count_));
    const std::uint64_t rank = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted));
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen >= rank) return static_cast<std::int64_t>(std::min(highest_of(i), max_));
    }
    return max_ns();
  }

private:
  static constexpr int kSubBits = 5;
  static constexpr std::uint64_t kSubBuckets = 1U << kSubBits;
  static constexpr std::size_t kBuckets = (64 - kSubBits) * kSubBuckets;

  // Values below 2 * kSubBuckets have a bucket each; above, the leading bit gives the group and the
  // next kSubBits bits the bucket in it.
  static std::size_t index_of(std::uint64_t value) {
    const int shift = std::max(0, static_cast<int>(std::bit_width(value)) - kSubBits - 1);
    return static_cast<std::size_t>(static_cast<std::uint64_t>(shift) * kSubBuckets +
                                    (value >> shift));
  }
  static std::uint64_t highest_of(std::size_t index) {
    const std::size_t shift = index < 2 * kSubBuckets ? 0 : index / kSubBuckets - 1;
    const std::uint64_t low = (index - shift * kSubBuckets) << shift;
    return low + (std::uint64_t{1} << shift) - 1;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::uint64_t max_ = 0;
};

}  // namespace scree
