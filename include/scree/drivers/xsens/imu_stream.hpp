#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/imu_sample.hpp"
#include "scree/drivers/xsens/framing.hpp"
#include "scree/drivers/xsens/mt_data2.hpp"
#include "scree/drivers/xsens/sample_clock.hpp"

namespace scree::xsens {

struct ImuCounters {
  std::uint64_t accepted = 0;                         ///< MTData2 messages handed out
  std::uint64_t samples = 0;                          ///< IMU samples handed out
  std::uint64_t oriented = 0;                         ///< of them: with an orientation
  std::uint64_t useful = 0;                           ///< ... or, before the first, with a rate
  std::uint64_t other_messages = 0;                   ///< whole, but not MTData2
  RefusalCounts refused{};                            ///< by Refusal
  std::uint64_t unknown_items = 0;                    ///< see ItemCounts
  std::uint64_t bytes_skipped = 0;                    ///< that belong to no message
  std::uint64_t lost = 0;                             ///< messages missing between accepted ones
  std::uint64_t device_restarts = 0, host_steps = 0;  ///< see DeviceClock

  std::uint64_t all_refused() const;
};

/// All there is between the bytes of an MTi's serial port and samples on the host's clock; the
/// daemon and the tools use it alike. Memory is fixed. Deterministic.
///
/// Orientation is the quaternion's, else the matrix's, else the Euler angles', turned to
/// east-north-up. The rate is the rate of turn, else the one of high rate, else from how far the
/// sensor turned since the sample before; the acceleration likewise. Sample times do not go back,
/// but where the clock started over.
class ImuStream {
public:
  using OnSample = std::function<void(const ImuSample&)>;
  using OnMeasurement = std::function<void(std::int64_t t_ns, const Measurement&)>;

  /// `on_measurement` gets every accepted message, `on_sample` those with orientation, rate or
  /// acceleration.
  ImuStream(const ImuSettings& settings, OnSample on_sample, OnMeasurement on_measurement = {});
  ImuStream(const ImuStream&) = delete;
  ImuStream& operator=(const ImuStream&) = delete;

  /// Takes what one read from the port gave. Any bytes are safe.
  /// @param arrival_ns host time at which the last of the bytes had come
  void take(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns);
  /// At the end of a capture: looks for messages in bytes that waited for more.
  void flush();

  const ImuCounters& counters() const { return counters_; }
  const DeviceClock& clock() const { return clock_.clock(); }

private:
  void take_message(const Message& message, std::int64_t arrival_ns);
  /// Whether a message is in sequence; sets how many are missing before it.
  Refusal check_sequence(const Measurement& measurement, std::int64_t arrival_ns);
  void take_inertial(const Measurement& measurement, const Arrival& arrival);
  std::int64_t increment_interval(const Measurement& measurement, std::int64_t elapsed_ns);
  void hand_out(const Measurement& measurement, std::int64_t t_ns, std::int64_t interval_ns,
                bool started_over);
  void update_counters();
  void refuse(Refusal reason) { ++refused_[static_cast<std::size_t>(reason)]; }

  OnSample on_sample_;
  OnMeasurement on_measurement_;
  Framer framer_;
  ItemCounts items_;
  SampleClock clock_;
  RefusalCounts refused_{};  ///< whole messages, after framing
  std::optional<std::uint16_t> last_counter_;
  std::optional<std::uint32_t> last_tick_;    ///< of the last sample
  std::int64_t last_arrival_ns_ = 0;          ///< of the last accepted message
  std::int64_t missing_ = 0;                  ///< messages lost just before this one
  std::optional<std::int64_t> last_t_ns_;     ///< of the last sample
  std::optional<std::int64_t> increment_ns_;  ///< device time since the last increments, if known
  std::int64_t increments_lost_ = 0;          ///< messages lost since then
  ImuCounters counters_;
};

}  // namespace scree::xsens
