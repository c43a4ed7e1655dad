#pragma once

#include <cstdint>
#include <scree/health_t.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace scree::cli {

/// UTC, as 12:34:56.789.
std::string time_of_day(std::int64_t stamp_ns);

/// The word for a sensor_health_t::state.
std::string_view state_name(std::int8_t state);
inline constexpr std::string_view kOff = "off";
/// The same of a sensor that the configuration may be without: IMU and encoder.
std::string_view optional_state_name(const sensor_health_t& sensor);
/// The word for a sensor_health_t::clock.
std::string_view clock_name(std::int8_t clock);

/// What was counted, and how often.
struct Count {
  std::string what;
  std::int64_t count;
};
using Counts = std::vector<Count>;

/// What one sensor lost or had refused, by reason; only counts that are not 0.
Counts losses_of(const sensor_health_t& sensor);
/// What was dropped behind the sensors, by reason; only counts that are not 0.
Counts drops_of(const health_t& health);

}  // namespace scree::cli
