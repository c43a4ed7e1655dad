#include "simulator/encoder.hpp"

#include <cmath>

namespace scree {

void put_signal(CanData& data, const EncoderSettings& layout, std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  int place = layout.start_bit;
  for (int i = 0; i < layout.length; ++i) {
    const bool is_little = layout.byte_order == ByteOrder::little_endian;
    const int bit = is_little ? i : layout.length - 1 - i;
    auto& byte = data[static_cast<std::size_t>(place / 8)];
    const auto mask = static_cast<std::uint8_t>(1U << static_cast<unsigned>(place % 8));
    const bool is_set = ((bits >> static_cast<unsigned>(bit)) & 1U) != 0;
    byte = static_cast<std::uint8_t>(is_set ? byte | mask : byte & ~mask);
    // The highest bit of a byte follows the lowest of the byte before.
    place += is_little ? 1 : (place % 8 == 0 ? 15 : -1);
  }
}

SimulatedEncoder::SimulatedEncoder(const Motion& motion, const EncoderSettings& layout,
                                   const SimulatedEncoderSettings& settings, std::uint64_t seed)
    : motion_(motion),
      layout_(layout),
      settings_(settings),
      random_(seed, 0xE4C),
      first_count_(random_.chance(0.3)
                       // Just below where a signed counter wraps.
                       ? (std::int64_t{1} << static_cast<unsigned>(layout.length - 1)) -
                             static_cast<std::int64_t>(random_.uniform(0, 3) / layout.scale)
                       : static_cast<std::int64_t>(random_.index(100'000))) {}

void SimulatedEncoder::advance(std::int64_t t_ns) {
  constexpr std::int64_t kStepNs = 5'000'000;
  if (!is_started_) last_ns_ = t_ns;
  is_started_ = true;
  const std::int64_t from_ns = last_ns_;
  const double before = turned_;
  while (last_ns_ < t_ns) {
    const std::int64_t next_ns = std::min(last_ns_ + kStepNs, t_ns);
    const double step = static_cast<double>(next_ns - last_ns_) * 1e-9;
    const double moved = motion_.distance(next_ns) - motion_.distance(last_ns_);
    const Eigen::Vector3d forward = motion_.base(next_ns).rotation * Eigen::Vector3d::UnitX();
    if (burst_left_ <= 0 && random_.chance(settings_.bursts_a_minute * step / 60)) {
      burst_ = random_.uniform(0.05, 0.3);
      burst_left_ = random_.uniform(0.2, 0.6);
    }
    const double climbed = moved < 0 ? -forward.z() : forward.z();
    double slip = settings_.slope_slip * climbed;
    if (burst_left_ > 0) slip += burst_;
    burst_left_ -= step;
    turned_ += moved * (1 + slip);
    last_ns_ = next_ns;
  }
  if (last_ns_ > from_ns) {
    speed_ = (turned_ - before) / (static_cast<double>(last_ns_ - from_ns) * 1e-9);
  }
}

CanData SimulatedEncoder::frame(std::int64_t t_ns) {
  advance(t_ns);
  const double scale = layout_.scale / (1 + settings_.scale_error);
  CanData data{};
  data[7] = alive_++;  // many controllers count their frames
  const std::int64_t value =
      layout_.kind == EncoderKind::counter
          ? first_count_ + static_cast<std::int64_t>(std::floor(turned_ / scale))
          : std::llround(speed_ / scale);
  put_signal(data, layout_, value);
  return data;
}

}  // namespace scree
