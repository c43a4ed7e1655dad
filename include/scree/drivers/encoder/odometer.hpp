#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "scree/config/settings.hpp"
#include "scree/drivers/encoder/refusal.hpp"

namespace scree::encoder {

/// The signal of one frame.
struct Reading {
  std::int64_t t_ns = 0;  ///< host time of the frame
  std::int64_t raw = 0;   ///< as sent, see read_signal()
  double value = 0;       ///< scaled: metres for a counter, m/s for a speed
};

/// Adds up the distance that the wheel has rolled, and refuses readings of which no wheel is the
/// cause. A counter moves by the smallest difference of two readings within its length; a speed by
/// its mean over the time between them.
///
/// Assumptions: a frame every 0.5 to 100 ms. A time stamp is off by up to 30 ms, because USB
/// adapters hand frames on in bursts; so speeds are judged over more than one interval, and one
/// step of the counter is never a speed by itself.
///
/// A reading is accepted, but for these rules, the first that applies:
///
/// - Not later than the accepted one before it: refused (time).
/// - A counter's, unchanged after four steps that were all larger than max_acceleration takes from
///   one frame to the next: refused (frozen), and so are those after it until one differs. After a
///   second they are accepted, because a wheel that was blocked looks the same.
/// - Too far from the one before for max_speed, or for max_acceleration from the speed of the last
///   250 ms: refused (implausible).
/// - When four or more that were refused for their time or as implausible agree with each other
///   over 50 ms, the last of them is accepted, and the distance goes on from there without the jump
///   before the first of them (rebased).
/// - A counter's, 350 ms or more after the one before, when it may have wrapped unseen; or after as
///   long without any frame, when it is nearer to zero than to where it was, and the speed before
///   speaks more for a device that has restarted at zero than for one that has counted on; a
///   speed's, as long after the one before: accepted without the difference (rebased).
class Odometer {
public:
  explicit Odometer(const EncoderSettings& settings);

  Refusal take(const Reading& reading);

  /// Metres since the first reading, backwards below zero.
  double distance() const { return distance_; }
  /// How often the distance went on without a difference that could not be told or believed.
  std::uint64_t rebased() const { return rebased_; }

private:
  /// Metres from one reading to a later one.
  double moved(const Reading& from, const Reading& to) const;
  /// Whether a wheel can be the cause of both, whatever it did before.
  bool agree(const Reading& from, const Reading& to) const;
  /// The mean speed over the accepted readings of the last 250 ms; nothing where these are too few.
  struct Trend {
    double window, speed;  ///< seconds, m/s
  };
  std::optional<Trend> trend() const;
  bool fits_trend(const Reading& reading) const;
  bool may_have_wrapped(const Reading& reading) const;
  bool has_restarted(const Reading& reading, double speed_before) const;
  bool stands_frozen(const Reading& reading);
  bool stopped_too_fast() const;
  Refusal suspect(Refusal reason, const Reading& reading);
  Refusal accept(const Reading& reading, double moved);
  Refusal rebase(const Reading& reading, double moved);

  EncoderSettings settings_;
  double quantum_;  ///< metres, or m/s, of one step
  double distance_ = 0;
  std::uint64_t rebased_ = 0;

  /// The accepted readings of the last 250 ms, oldest first: when, and the distance by then.
  struct Past {
    std::int64_t t_ns;
    double distance;
  };
  std::array<Past, 512> past_{};
  std::size_t past_size_ = 0;

  bool has_last_ = false, has_frame_ = false;
  Reading last_;                    ///< the last accepted one
  std::int64_t last_frame_ns_ = 0;  ///< of the last one, accepted or not

  // The row of refused readings that agree with each other.
  int suspects_ = 0;
  Reading first_suspect_, last_suspect_;
  double suspects_moved_ = 0;

  bool is_frozen_ = false;
  std::int64_t frozen_since_ns_ = 0;
};

}  // namespace scree::encoder
