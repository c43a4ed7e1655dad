#include "live/health_words.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

#include "scree/core/nanoseconds.hpp"

namespace scree::cli {
namespace {

template <std::size_t size>
std::string_view name_in(const std::array<std::string_view, size>& names, std::int8_t value) {
  const auto index = static_cast<std::uint8_t>(value);
  return index < size ? names[index] : "unknown";
}

void remove_zeros(Counts& counts) {
  std::erase_if(counts, [](const Count& one) { return one.count == 0; });
}

}  // namespace

std::string time_of_day(std::int64_t stamp_ns) {
  const std::int64_t in_day = (stamp_ns % (86400 * kSecond) + 86400 * kSecond) % (86400 * kSecond);
  const std::int64_t seconds = in_day / kSecond;
  return fmt::format("{:02}:{:02}:{:02}.{:03}", seconds / 3600, seconds / 60 % 60, seconds % 60,
                     in_day % kSecond / 1'000'000);
}

std::string_view state_name(std::int8_t state) {
  constexpr std::array<std::string_view, 5> kNames = {"never seen", "ok", "silent", "wrong data",
                                                      "slow"};
  return name_in(kNames, state);
}

std::string_view optional_state_name(const sensor_health_t& sensor) {
  const bool is_named = !sensor.source.empty();
  return is_named || sensor.state != sensor_health_t::NEVER_SEEN ? state_name(sensor.state) : kOff;
}

std::string_view clock_name(std::int8_t clock) {
  constexpr std::array<std::string_view, 3> kNames = {"unsynchronised", "estimated", "PPS-locked"};
  return name_in(kNames, clock);
}

Counts losses_of(const sensor_health_t& sensor) {
  Counts counts = {{"lost", sensor.lost}, {"dropped by the kernel", sensor.kernel_drops}};
  for (std::size_t i = 0; i < sensor.refused.size(); ++i) {
    counts.push_back({"refused for " + sensor.refused_reason[i], sensor.refused[i]});
  }
  remove_zeros(counts);
  return counts;
}

Counts drops_of(const health_t& health) {
  Counts counts = {{"sweeps dropped", health.sweeps_dropped},
                   {"sweeps without a return", health.sweeps_empty},
                   {"sweeps without all motion", health.sweeps_not_covered},
                   {"sweeps with a slipping wheel", health.sweeps_slipped},
                   {"resets of the heading", health.heading_resets},
                   {"lists failed", health.lists_failed},
                   {"lists dropped", health.lists_dropped},
                   {"points dropped", health.points_dropped},
                   {"points refused", health.points_refused},
                   {"edge points dropped", health.edge_points_dropped},
                   {"obstacles dropped", health.obstacles_dropped},
                   {"map points dropped", health.map_points_dropped},
                   {"tracks dropped", health.tracks_dropped},
                   {"samples dropped", health.samples_dropped},
                   {"samples refused", health.samples_refused}};
  remove_zeros(counts);
  return counts;
}

}  // namespace scree::cli
