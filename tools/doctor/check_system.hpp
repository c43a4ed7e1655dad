#pragma once

#include <cstdint>
#include <optional>
#include <scree/sensor_health_t.hpp>
#include <string>
#include <string_view>

#include "doctor/finding.hpp"

namespace scree {

/// What the kernel lets a process do, from its texts under /proc.
struct Rights {
  std::uint64_t priority = 0;      ///< highest real-time priority
  std::uint64_t locked_bytes = 0;  ///< of memory
};
/// @param limits /proc/PID/limits  @param status /proc/PID/status
Rights rights_of(std::string_view limits, std::string_view status);

/// How screed runs; without it what this user may.
struct Running {
  bool is_running = false;
  bool has_real_time = false;  ///< any thread of it
  std::uint64_t locked_kilobytes = 0;
};
Finding check_priority(const Running& screed, const Rights& own);
Finding check_memory(const Running& screed, const Rights& own);

/// @param state what adjtimex() returned  @param error_us its estimate of the greatest error
Finding check_clock(int state, std::int64_t error_us);

/// A serial port, as it stands under /dev and /sys.
struct SerialFacts {
  bool exists = false, is_terminal = false, may_use = false;
  std::string group;                 ///< that may use it
  std::optional<int> latency_timer;  ///< milliseconds; nothing where the driver has none
  std::string timer_file;            ///< that it was read from
};
Finding check_serial(const std::string& device, const SerialFacts& facts);

/// What screed says of a sensor. @param advice what to look at where nothing comes
Finding check_sensor(const std::string& subject, const sensor_health_t& health,
                     const std::string& advice);

}  // namespace scree
