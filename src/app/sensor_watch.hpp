#pragma once

#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <scree/sensor_health_t.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "log_lines.hpp"
#include "scree/clock/device_clock.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {

/// What SensorWatch asks of any sensor. Times are of the steady clock, 0 before the first; counts
/// are since the start.
struct SensorStatus {
  struct Refused {
    std::string_view name;    ///< in health
    std::string_view reason;  ///< for people
    std::uint64_t count;
  };

  static constexpr std::size_t kMostReasons = 24;

  std::string_view source;
  std::string_view advice;           ///< what to look at when it is silent; empty: as always
  std::int64_t last_heard_ns = 0;    ///< anything at all
  std::int64_t last_message_ns = 0;  ///< understood
  std::uint64_t messages = 0, lost = 0, kernel_drops = 0;
  boost::container::static_vector<Refused, kMostReasons> refused;
  ClockStatus clock;

  /// Why most was refused.
  std::string_view main_reason() const;
};

/// Finds the state of one sensor, fills in its part of health and adds what a person should read to
/// the log. It reads no clock: `now_ns` is the steady clock's.
///
/// | state      | when                                                               |
/// |------------|--------------------------------------------------------------------|
/// | NEVER_SEEN | nothing has come since the start                                   |
/// | SILENT     | nothing for kSilence                                               |
/// | WRONG_DATA | something has come for kSilence, and nothing of it was understood  |
/// | SLOW       | under 90 % of the expected rate in a second, until 95 % come again |
/// | OK         | else                                                               |
class SensorWatch {
public:
  // The daemon looks every 20 ms, so that silence is published within 300 ms. A VLP-16 sends a
  // packet every 1.3 ms, an MTi a message every 10 ms, an encoder a frame every 100 ms at least.
  static constexpr std::int64_t kSilence = 200 * kMillisecond;

  struct Terms {
    std::string messages;      ///< "packets on UDP port 2368"
    std::string advice;        ///< what to look at when they do not come
    double expected_rate = 0;  ///< of messages, a second; 0: all that came and that were lost
  };

  SensorWatch(Terms terms, std::int64_t now_ns);

  /// Brings `health` up to date and adds to `log`. True when the state changed, or the clock's.
  bool update(std::int64_t now_ns, const SensorStatus& status, sensor_health_t& health,
              LogLines& log);

private:
  /// The state but for SLOW.
  std::int8_t state_at(std::int64_t now_ns, const SensorStatus& status) const;
  void update_rate(std::int64_t now_ns, const SensorStatus& status, sensor_health_t& health);
  std::string_view advice(const SensorStatus& status) const {
    return status.advice.empty() ? std::string_view(terms_.advice) : status.advice;
  }
  LogLine line_of(std::int64_t now_ns, const SensorStatus& status, const sensor_health_t& health,
                  std::int8_t before) const;

  Terms terms_;
  std::int64_t start_ns_, last_heard_ns_ = 0, last_message_ns_ = 0;
  std::int64_t silent_since_ns_ = 0;   ///< of the last silence
  std::int64_t unclear_since_ns_ = 0;  ///< nothing of what came from then on was understood
  bool logged_missing_ = false;

  // The second over which the rate is measured; it begins anew when the state changes.
  std::int8_t state_ = sensor_health_t::NEVER_SEEN;
  std::int64_t begin_ns_ = 0;
  std::uint64_t begin_messages_ = 0, begin_lost_ = 0;
  bool is_slow_ = false;

  std::vector<GrowthLog> refused_;
  GrowthLog kernel_drops_;
};

}  // namespace scree
