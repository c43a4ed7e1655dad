#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "scree/core/nanoseconds.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree::xsens {

using test::ByteVector;
using test::data_message;
using test::integer;
using test::reals;

inline constexpr std::int64_t kEpoch = 1'598'612'523 * kSecond;

inline ByteVector counter(unsigned value) {
  return integer(0x1020, value & 0xFFFFU, 2);
}
inline ByteVector tick(std::uint64_t value) {
  return integer(0x1060, value & 0xFFFFFFFFU, 4);
}
inline const ByteVector kTurn = reals(0x2010, {1, 0, 0, 0});
inline const ByteVector kRate = reals(0x8020, {0.5, -0.25, 2});
inline const ByteVector kForce = reals(0x4020, {1, 2, 9.75});

/// A stream and what it gave.
struct Listener {
  std::vector<ImuSample> samples;
  std::vector<std::int64_t> measured_ns;
  ImuStream stream;

  explicit Listener(int baud = 921600)
      : stream(
            settings(baud), [this](const ImuSample& sample) { samples.push_back(sample); },
            [this](std::int64_t t_ns, const Measurement&) { measured_ns.push_back(t_ns); }) {}
  static ImuSettings settings(int baud) {
    ImuSettings imu;
    imu.baud = baud;
    return imu;
  }
  std::uint64_t refused(Refusal reason) const {
    return stream.counters().refused[static_cast<std::size_t>(reason)];
  }
};

/// Sends one message every 10 ms.
class Steady {
public:
  explicit Steady(Listener& listener) : listener_(listener) {}
  void operator()(std::initializer_list<ByteVector> items) {
    listener_.stream.take(data_message(items), now_ns);
    now_ns += 10 * kMillisecond;
  }
  std::int64_t now_ns = kEpoch;

private:
  Listener& listener_;
};

}  // namespace scree::xsens
