#include "sensor_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <utility>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

// Shares of the expected rate: a sensor is slow that loses one message in ten. The second is higher
// so that a rate near the first does not change the state each second.
constexpr double kSlow = 0.90, kSlowNoMore = 0.95;

static_assert(static_cast<int>(ClockState::unsynchronised) == sensor_health_t::UNSYNCHRONISED &&
              static_cast<int>(ClockState::estimated) == sensor_health_t::ESTIMATED &&
              static_cast<int>(ClockState::pps_locked) == sensor_health_t::PPS_LOCKED);

std::int64_t signed_count(std::uint64_t count) {
  return static_cast<std::int64_t>(count);
}

void fill(const SensorStatus& status, sensor_health_t& health) {
  health.source = status.source;
  health.messages = signed_count(status.messages);
  health.lost = signed_count(status.lost);
  health.kernel_drops = signed_count(status.kernel_drops);
  health.refused_reason.resize(status.refused.size());
  health.refused.resize(status.refused.size());
  for (std::size_t i = 0; i < status.refused.size(); ++i) {
    health.refused_reason[i] = status.refused[i].name;
    health.refused[i] = signed_count(status.refused[i].count);
  }
  health.reasons = static_cast<std::int32_t>(health.refused.size());
  health.clock = static_cast<std::int8_t>(status.clock.state);
  health.clock_offset_s = static_cast<double>(status.clock.offset_ns) / 1e9;
  health.clock_accuracy_ms = static_cast<double>(status.clock.accuracy_ns) / 1e6;
}

}  // namespace

std::string_view SensorStatus::main_reason() const {
  const auto most =
      std::max_element(refused.begin(), refused.end(),
                       [](const Refused& a, const Refused& b) { return a.count < b.count; });
  return most == refused.end() || most->count == 0 ? "no message in it" : most->reason;
}

SensorWatch::SensorWatch(Terms terms, std::int64_t now_ns)
    : terms_(std::move(terms)), start_ns_(now_ns) {}

bool SensorWatch::update(std::int64_t now_ns, const SensorStatus& status, sensor_health_t& health,
                         LogLines& log) {
  const std::int8_t before = health.state, clock_before = health.clock;
  fill(status, health);
  if (status.last_heard_ns - last_heard_ns_ > kSilence) {
    silent_since_ns_ = last_heard_ns_;
    unclear_since_ns_ = 0;  // half a message before the silence says nothing of what follows
  }
  last_heard_ns_ = status.last_heard_ns;
  if (status.last_message_ns != last_message_ns_) unclear_since_ns_ = 0;
  last_message_ns_ = status.last_message_ns;
  if (unclear_since_ns_ == 0 && last_heard_ns_ > last_message_ns_) {
    unclear_since_ns_ = last_heard_ns_;
  }
  update_rate(now_ns, status, health);
  const bool is_slow = state_ == sensor_health_t::OK && is_slow_;
  health.state = is_slow ? sensor_health_t::SLOW : state_;

  if (health.state != before) log.push_back(line_of(now_ns, status, health, before));
  if (state_ == sensor_health_t::NEVER_SEEN && !logged_missing_ && now_ns - start_ns_ >= kSecond) {
    log.push_back({true, fmt::format("no {} have come yet: {}", terms_.messages, advice(status))});
    logged_missing_ = true;
  }
  refused_.resize(status.refused.size());
  for (std::size_t i = 0; i < refused_.size(); ++i) {
    const auto what = [&] {
      return fmt::format("{} refused: {}", terms_.messages, status.refused[i].reason);
    };
    refused_[i].update(now_ns, status.refused[i].count, what, log);
  }
  const auto drops = [&] {
    return fmt::format("{} dropped by the kernel: the reader was too slow", terms_.messages);
  };
  kernel_drops_.update(now_ns, status.kernel_drops, drops, log);
  return health.state != before || health.clock != clock_before;
}

std::int8_t SensorWatch::state_at(std::int64_t now_ns, const SensorStatus& status) const {
  if (status.last_heard_ns == 0) return sensor_health_t::NEVER_SEEN;
  if (now_ns - status.last_heard_ns > kSilence) return sensor_health_t::SILENT;
  const bool is_understood =
      status.last_message_ns != 0 && now_ns - status.last_message_ns <= kSilence;
  if (is_understood) return sensor_health_t::OK;
  return now_ns - unclear_since_ns_ > kSilence ? sensor_health_t::WRONG_DATA : state_;
}

void SensorWatch::update_rate(std::int64_t now_ns, const SensorStatus& status,
                              sensor_health_t& health) {
  const std::int8_t state = state_at(now_ns, status);
  const std::int64_t elapsed_ns = now_ns - begin_ns_;
  if (state != state_) {
    health.rate = 0;
    is_slow_ = false;
  } else if (elapsed_ns >= kSecond) {
    const auto per_second = [&](std::uint64_t count) {
      return static_cast<double>(count) / (static_cast<double>(elapsed_ns) * 1e-9);
    };
    health.rate = per_second(status.messages - begin_messages_);
    health.expected_rate = terms_.expected_rate > 0
                               ? terms_.expected_rate
                               : health.rate + per_second(status.lost - begin_lost_);
    is_slow_ = health.rate < health.expected_rate * (is_slow_ ? kSlowNoMore : kSlow);
  } else {
    return;
  }
  state_ = state;
  begin_ns_ = now_ns;
  begin_messages_ = status.messages;
  begin_lost_ = status.lost;
}

LogLine SensorWatch::line_of(std::int64_t now_ns, const SensorStatus& status,
                             const sensor_health_t& health, std::int8_t before) const {
  const std::string& messages = terms_.messages;
  switch (health.state) {
    case sensor_health_t::SILENT:
      return {true, fmt::format("no {} any more: {}", messages, advice(status))};
    case sensor_health_t::WRONG_DATA:
      return {true, fmt::format("{} are not understood ({}): is it the configured sensor, and set "
                                "up as configured?",
                                messages, status.main_reason())};
    case sensor_health_t::SLOW:
      return {true, fmt::format("only {:.0f} of {:.0f} {} a second: a bad line, a busy computer, "
                                "or another rate set in the sensor?",
                                health.rate, health.expected_rate, messages)};
    default:
      break;
  }
  switch (before) {
    case sensor_health_t::NEVER_SEEN:
      return {false, fmt::format("{} come and are understood", messages)};
    case sensor_health_t::SILENT:
      return {false, fmt::format("{} again after {:.1f} s", messages,
                                 static_cast<double>(now_ns - silent_since_ns_) / kSecond)};
    case sensor_health_t::SLOW:
      return {false, fmt::format("{} as many as there should be again", messages)};
    default:
      return {false, fmt::format("{} are understood", messages)};
  }
}

}  // namespace scree
