#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "scree/clock/clock_line.hpp"
#include "scree/clock/delay_envelope.hpp"
#include "scree/clock/pps_edges.hpp"

namespace scree {

enum class ClockState : std::uint8_t {
  unsynchronised,  ///< too few packets yet: times may be late by a packet's delay
  estimated,       ///< from times of arrival: times are late by the least delay of the way
  pps_locked       ///< from the edges of a pulse per second: no delay in it
};

/// "unsynchronised", "estimated" or "pps_locked".
const char* name_of(ClockState state);

/// How well a device's clock is known, for people.
struct ClockStatus {
  ClockState state = ClockState::unsynchronised;
  std::int64_t offset_ns = 0;    ///< host time minus device time, within half a period around zero
  std::int64_t accuracy_ns = 0;  ///< see DeviceClock
};

/// A device's clock on the host's: from the device's time stamps and the host's times of arrival,
/// and where there is a pulse per second from its edges. The offset and the skew are those of
/// DelayEnvelope or PpsEdges.
///
/// Times given out never run backwards for device times that run forwards, but for a restart: what
/// is learnt is brought in over the next packets, by a quarter of the time that goes by at most,
/// and by half of it while unsynchronised. So a first packet that was 4 ms late spoils 8 ms.
///
/// Assumptions: the clocks run apart by less than 200 ppm; a gap in the data is measured by the
/// host's clock, so that a device clock that wraps (a lidar's at the full hour) is followed over
/// any gap; the least delay stays the same. A bus that is asked at ticks as steady as the device's
/// own hides how far it lies behind: up to the greatest common divisor of both periods.
///
/// What happens, and what comes of it:
/// | packets                              | taken for                 | what is done           |
/// |--------------------------------------|---------------------------|------------------------|
/// | late by less than 5 ms               | a delay                   | the envelope's work    |
/// | all late by 5 ms or more for 1 s     | the host's clock was set  | start over             |
/// | early by 1 to 50 ms, twice in 10 s   | all before were late, or  | the envelope begins    |
/// |                                      | a small step of the host  | anew, times slew down  |
/// | early by more, late by 1 s or older  | a restart of the device,  | start over             |
/// | than the last by 50 ms, agreeing for | a gain of GPS lock, or    |                        |
/// | 100 ms                               | the host's clock was set  |                        |
/// | the same, but only now and then      | garbled stamps            | nothing: left out      |
///
/// Until a restart is certain, and for garbled stamps, to_host() of the stamp is about its time of
/// arrival. Deterministic: integers only, time is an argument. One thread may use it.
class DeviceClock {
public:
  /// The device's clock wraps after `period_ns`.
  explicit DeviceClock(std::int64_t period_ns) : period_ns_(period_ns) {}

  /// Takes the device's time of the moment that the packet was complete, in [0, period), and the
  /// host's time of its arrival. Returns true when it had to start over: times before and after do
  /// not compare.
  bool update(std::int64_t device_ns, std::int64_t arrival_ns);

  /// Takes the host's time of an edge at which the device's clock stood at a whole second. Which
  /// second it was is known from the packets; so edges count only once the state is `estimated`,
  /// and only where the packets then took 0 to 20 ms, at the least, to arrive. Periods must be of
  /// whole seconds, else edges count for nothing. The lock is given up 5 s after the last edge.
  void pps(std::int64_t host_edge_ns);

  /// Host time of a device time that lies less than half a period from the last update.
  /// @pre update() was called
  std::int64_t to_host(std::int64_t device_ns) const;

  ClockState state() const { return state_; }
  /// How far off to_host() may be at the last update, apart from the least delay where `estimated`.
  std::int64_t accuracy_ns() const;
  /// How much longer the host finds a second of the device, in 1e-9.
  std::int64_t skew_ppb() const { return slewed_.skew_ppb; }

  std::uint64_t device_restarts() const { return device_restarts_; }
  std::uint64_t host_steps() const { return host_steps_; }
  /// Packets whose time stamp was left out.
  std::uint64_t implausible() const { return implausible_; }
  /// Edges that did not agree with the packets or with the edges before.
  std::uint64_t edges_refused() const { return edges_refused_; }

  /// Before the first update a default one.
  /// @param ahead_ns added to the host's time: for a clock that people read
  ClockStatus status(std::int64_t ahead_ns = 0) const;

private:
  /// Packets that do not fit the estimate, but one another.
  struct Outliers {
    std::int64_t first_device_ns, first_arrival_ns;
    ClockSample least;  ///< of the least delay
  };
  /// Late packets, one after the other.
  struct LateRun {
    std::int64_t since_ns;  ///< arrival of the first
    ClockSample least;
  };

  bool handle_outlier(std::int64_t device_ns, std::int64_t arrival_ns, bool has_waited);
  bool is_late_for_long(const ClockSample& sample);
  void accept(const ClockSample& sample);
  void restart(const ClockSample& newest, const ClockSample& least);
  void slew_to(std::int64_t device_ns);
  ClockState next_state() const;
  ClockLine best_line() const;
  /// The difference of two device times, within half a period.
  std::int64_t wrapped(std::int64_t difference_ns) const;

  std::int64_t period_ns_;
  bool started_ = false;
  ClockState state_ = ClockState::unsynchronised;

  // The newest packet taken; its device time is last_.device_ns modulo the period.
  ClockSample last_;
  std::int64_t begin_device_ns_ = 0;  ///< of the first packet since it started over
  std::int64_t packets_ = 0;          ///< since then
  DelayEnvelope envelope_;
  ClockLine slewed_;  ///< what to_host() tells: follows the best line

  // Device and host time that to_host() counts from: those of the last update.
  std::int64_t anchor_device_ns_ = 0, anchor_host_ns_ = 0;

  std::optional<Outliers> outliers_;
  std::optional<LateRun> late_run_;
  std::optional<ClockSample> early_;  ///< one early packet that waits for a second one

  PpsEdges edges_;
  std::int64_t last_edge_ns_ = 0;

  std::uint64_t device_restarts_ = 0, host_steps_ = 0, implausible_ = 0, edges_refused_ = 0;
};

}  // namespace scree
