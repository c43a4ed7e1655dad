#pragma once

#include <array>
#include <cstdint>

#include "scree/config/settings.hpp"
#include "scree/core/random.hpp"
#include "simulator/motion.hpp"

namespace scree {

struct SimulatedEncoderSettings {
  double rate_hz = 100;        ///< frames a second
  double scale_error = 0.003;  ///< of the wheel's radius: share that it counts too much
  double slope_slip = 0.03;    ///< share of turning in place for each unit of slope climbed
  double bursts_a_minute = 6;  ///< of slip on loose ground, 0.2-0.6 s long, 5-30 %
};

/// One frame's payload.
using CanData = std::array<std::uint8_t, 8>;

/// Writes the lowest `length` bits of a value as a DBC signal: start_bit is the lowest bit's place
/// for little_endian and the highest bit's for big_endian, whose bits run down each byte.
/// @pre the signal lies within the eight bytes
void put_signal(CanData& data, const EncoderSettings& layout, std::int64_t value);

/// A wheel's encoder on a moving robot. The wheel turns further than the robot drives where it
/// slips, and less far than the ground is long where it slides down.
class SimulatedEncoder {
public:
  /// Keeps a reference to the motion.
  /// @param layout kind, scale and place of the signal
  SimulatedEncoder(const Motion& motion, const EncoderSettings& layout,
                   const SimulatedEncoderSettings& settings, std::uint64_t seed);

  /// What it sends at a time, which must not be before the one asked for last.
  CanData frame(std::int64_t t_ns);
  /// Metres that the wheel has turned so far, without its scale error.
  double turned() const { return turned_; }

private:
  void advance(std::int64_t t_ns);

  const Motion& motion_;
  EncoderSettings layout_;
  SimulatedEncoderSettings settings_;
  Random random_;
  std::int64_t first_count_;
  std::int64_t last_ns_ = 0;
  double turned_ = 0, speed_ = 0;
  double burst_ = 0, burst_left_ = 0;  // share and seconds
  std::uint8_t alive_ = 0;
  bool is_started_ = false;
};

}  // namespace scree
