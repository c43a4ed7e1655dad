#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>

#include "scree/drivers/encoder/odometer.hpp"
#include "scree/drivers/encoder/signal.hpp"

namespace scree::encoder {

/// A wheel with an encoder that sends a frame at regular intervals, and an odometer that takes
/// them.
class Wheel {
public:
  explicit Wheel(const EncoderSettings& settings, std::int64_t interval_ns = 10'000'000)
      : odometer(settings), settings_(settings), interval_ns_(interval_ns) {}

  /// Rolls on at a speed that changes evenly, and sends. Returns how many were refused.
  int roll(double seconds, double from_speed, double to_speed) {
    const int frames =
        static_cast<int>(std::lround(seconds * 1e9 / static_cast<double>(interval_ns_)));
    int refused = 0;
    for (int i = 0; i < frames; ++i) {
      speed = from_speed + (to_speed - from_speed) * (i + 1) / frames;
      const double before = from_speed + (to_speed - from_speed) * i / frames;
      way += (before + speed) / 2 * static_cast<double>(interval_ns_) * 1e-9;
      t_ns += interval_ns_;
      refused += send(raw()) == Refusal::none ? 0 : 1;
    }
    return refused;
  }
  /// Time goes by without frames.
  void pause(double seconds) { t_ns += static_cast<std::int64_t>(seconds * 1e9); }
  Refusal send(std::int64_t raw) { return send(raw, stamp()); }
  Refusal send(std::int64_t raw, std::int64_t stamp_ns) {
    const Refusal refusal = odometer.take({stamp_ns, raw, scaled(settings_, raw)});
    ++seen[refusal];
    return refusal;
  }
  /// What the encoder sends now.
  std::int64_t raw() const {
    if (settings_.kind == EncoderKind::speed) return std::llround(speed / settings_.scale);
    const auto count = static_cast<std::int64_t>(std::floor(way / settings_.scale)) + first_count;
    const auto unused = static_cast<unsigned>(64 - settings_.length);
    const std::uint64_t cut = static_cast<std::uint64_t>(count) << unused;
    return settings_.is_signed ? static_cast<std::int64_t>(cut) >> unused
                               : static_cast<std::int64_t>(cut >> unused);
  }
  /// Frames that are sent within 16 ms get there together, as USB adapters hand them on.
  std::int64_t stamp() {
    if (!is_in_bursts) return t_ns;
    constexpr std::int64_t kBurst = 16'000'000;
    last_stamp_ns_ = std::max((t_ns / kBurst + 1) * kBurst, last_stamp_ns_ + 20'000);
    return last_stamp_ns_;
  }

  Odometer odometer;
  std::map<Refusal, int> seen;
  std::int64_t t_ns = 1'598'601'600'000'000'000;
  std::int64_t first_count = 0;
  double way = 0, speed = 0;
  bool is_in_bursts = false;

private:
  EncoderSettings settings_;
  std::int64_t interval_ns_, last_stamp_ns_ = 0;
};

}  // namespace scree::encoder
