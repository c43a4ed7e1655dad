#pragma once

#include <cstdint>
#include <functional>

#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"

namespace scree::velodyne {

/// A sweep of a sensor that does not turn ends after this: a little over a turn at 300 rpm, the
/// slowest that can be set.
inline constexpr std::int64_t kLongestSweepNs = 220'000'000;

/// In this time a sensor that turns has turned once.
inline constexpr std::int64_t kSlowestTurnNs = 210'000'000;

/// Points of the largest sweep: every shot of that time with two returns.
inline constexpr std::size_t kSweepCapacity =
    static_cast<std::size_t>(kLongestSweepNs / kFiringNs + 1) * kLasers * 2;

/// Gathers the returns of shots into sweeps. A sweep ends where a shot's azimuth passes the cut, or
/// after kLongestSweepNs. The first sweep is the rest of the turn that was under way.
///
/// Where a turn has parts, what there is of it so far is handed out at the end of each of them,
/// too.
///
/// With dual returns a shot that has one echo reports it twice; the second of two equal returns is
/// left out, so that an echo is one point whatever the mode.
class SweepBuilder {
public:
  /// `on_sweep` may swap the sweep with another one of kSweepCapacity.
  /// @param parts equal angles of a turn
  SweepBuilder(double cut_azimuth_deg, int parts, std::function<void(Sweep&)> on_sweep);

  /// Takes the shots of the next packet, whose time stamp is `device_ns` on a clock that does not
  /// wrap; `to_host_ns` is what brings device times to the host's clock.
  void add(const Shots& shots, std::int64_t device_ns, std::int64_t to_host_ns);

  /// Hands out what there is of the sweep under way, if anything, as the end of a turn.
  void finish();

  /// The same, because the sensor has started over; the next sweep says so.
  void start_over();

  /// How long before the last shot the last return came, by the sensor's clock.
  std::int64_t without_return_ns() const { return last_shot_ns_ - last_return_ns_; }

private:
  bool passes_cut(float azimuth, std::int64_t shot_ns);
  int part_at(float behind_cut) const;
  bool ends_part() const;
  void hand_out_part();
  void hand_out(Sweep& sweep);

  float cut_azimuth_;  ///< hundredths of a degree
  int parts_;          ///< of a turn
  int part_ = 0;       ///< the one under way
  std::function<void(Sweep&)> on_sweep_;
  Sweep sweep_{kSweepCapacity};  ///< its times count from begin_ns_ until it is finished
  Sweep so_far_;                 ///< a copy, where a turn has parts
  std::int64_t begin_ns_ = 0;    ///< device time of its first shot
  std::int64_t last_shot_ns_ = 0, last_return_ns_ = 0, last_cut_ns_ = 0;
  std::int64_t to_host_ns_ = 0;  ///< at the last shot: the clock may have started over since
  std::uint64_t turn_ = 0;       ///< the one under way
  float behind_cut_ = 0;  ///< how far the last shot lay behind the cut; hundredths of a degree
  bool open_ = false, was_cut_ = false;
  bool started_over_ = false;
  bool begins_at_cut_ = false, ends_at_cut_ = false, is_standing_ = false;
};

}  // namespace scree::velodyne
