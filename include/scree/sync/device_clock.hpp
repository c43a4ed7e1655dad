#pragma once

#include <cstdint>

namespace scree {

/// A device's clock on the host's: from the device's time stamps and the host's times of arrival.
///
/// A packet cannot arrive before it was sent, and now and then one arrives with next to no delay.
/// So the smallest difference "arrival minus device time" is the difference of the clocks, plus
/// that least delay. The estimate follows a smaller difference at once and lets go slowly upwards,
/// to follow clocks that run apart.
///
/// Assumptions: the clocks run apart by less than 200 ppm; a gap in the data is measured by the
/// host's clock, so that a device clock that wraps (a lidar's at the full hour) is followed over
/// any gap; with or without a GPS time base makes no difference.
///
/// What happens, and how it shows:
/// - delays and bursts: a positive residual, now and again near zero;
/// - clocks that run apart: the estimate leaks upwards or is pushed down;
/// - the device restarts, or jumps because GPS lock is gained: a residual beyond limits, while the
///   host's clock went on steadily;
/// - the host's clock is set: a residual beyond limits, while the device's clock went on steadily;
/// - the host's clock is set forward by a little: no residual near zero for a second.
///
/// Deterministic: integers only, time is an argument.
class DeviceClock {
public:
  /// The device's clock wraps after `period_ns`.
  explicit DeviceClock(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// Takes the device's time of the moment that the packet was complete, in [0, period), and the
  /// host's time of its arrival. Returns true when it had to start over: times before and after do
  /// not compare.
  bool update(std::int64_t device_ns, std::int64_t arrival_ns);

  /// Host time of a device time that lies less than half a period from the last update.
  /// @pre update() was called
  std::int64_t to_host(std::int64_t device_ns) const;

  std::uint64_t device_restarts() const { return device_restarts_; }
  std::uint64_t host_steps() const { return host_steps_; }

  /// Host time minus device time, within half a period around zero: for people.
  std::int64_t offset_ns() const;

private:
  void start_over(std::int64_t device_ns, std::int64_t arrival_ns);
  /// The difference of two device times, within half a period.
  std::int64_t wrapped(std::int64_t difference_ns) const;

  std::int64_t period_ns_;
  bool started_ = false;
  std::int64_t device_ns_ = 0;      ///< of the last update
  std::int64_t arrival_ns_ = 0;     ///< of the last update
  std::int64_t host_ns_ = 0;        ///< the last device time on the host's clock
  std::int64_t late_since_ns_ = 0;  ///< arrival of the first of an unbroken row of late packets
  std::int64_t least_late_ns_ = 0;  ///< smallest residual in that row; 0 when there is no row
  std::uint64_t device_restarts_ = 0, host_steps_ = 0;
};

}  // namespace scree
