#pragma once

#include <cstdint>

namespace scree {

/// The host's two clocks, read together.
struct ClockReading {
  std::int64_t monotonic_ns = 0;  ///< never set; runs while the host runs
  std::int64_t real_ns = 0;       ///< since the UNIX epoch; somebody may set it
  /// How long the reading took: what the thread lost in between makes the two differ.
  std::int64_t width_ns = 0;
};

/// Brings wall-clock stamps, as the kernel gives them to datagrams and CAN frames, to the monotonic
/// clock, and monotonic times back to wall-clock time where they leave the program. Between the two
/// edges everything runs on the monotonic clock, so that setting the wall clock disturbs nothing.
///
/// The clocks differ by an amount that changes only when the wall clock is set: slewing by NTP
/// moves both. Just after that, stamps of before may still wait to be read; of the two differences
/// that one is right which makes the stamp the younger, but not one of the future.
///
/// Time is an argument. One thread may use it.
class HostClock {
public:
  /// A changed difference within this is the reading's.
  static constexpr std::int64_t kJitter = 100'000;
  /// After a step stamps from before it wait to be read for less than this.
  static constexpr std::int64_t kLongestWait = 2'000'000'000;
  /// Stamps that waited while the process was paused are no older than this.
  static constexpr std::int64_t kOldest = 3600 * std::int64_t{1'000'000'000};

  /// Monotonic time of a wall-clock stamp that was taken before `now`. A stamp that is older than
  /// kOldest or of the future is given the time of `now`.
  std::int64_t to_monotonic(std::int64_t real_ns, const ClockReading& now);
  /// The same in wall-clock time, by the wall clock as it was set at first: what a recording keeps,
  /// in which time must run on.
  std::int64_t to_first_real(std::int64_t real_ns, const ClockReading& now);
  /// Wall-clock time of a monotonic time, by the wall clock as it is set now.
  std::int64_t to_real(std::int64_t monotonic_ns, const ClockReading& now);

  /// How often the wall clock was set by more than kJitter.
  std::uint64_t steps() const { return steps_; }

private:
  void look(const ClockReading& now);

  bool has_looked_ = false;
  std::int64_t first_ns_ = 0;       ///< real minus monotonic when it first looked
  std::int64_t difference_ns_ = 0;  ///< the same now
  std::int64_t before_ns_ = 0;      ///< the same before the last step
  std::int64_t step_ns_ = 0;        ///< monotonic time at which the last step was seen
  std::uint64_t steps_ = 0;
};

}  // namespace scree
