#include "metrics_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

namespace scree {
namespace {

/// Writes families of metrics, each with its head and then its samples.
class Writer {
public:
  void family(std::string_view name, std::string_view type, std::string_view help) {
    name_ = name;
    fmt::format_to(std::back_inserter(text_), "# HELP scree_{} {}\n# TYPE scree_{} {}\n", name,
                   help, name, type);
  }
  void sample(double value, std::string_view label = {}, std::string_view of = {}) {
    if (!std::isfinite(value)) return;
    const std::string labels =
        label.empty() ? "" : fmt::format("{{{}=\"{}\"}}", label, escaped(of));
    fmt::format_to(std::back_inserter(text_), "scree_{}{} {}\n", name_, labels, value);
  }
  void one(std::string_view name, std::string_view type, std::string_view help, double value) {
    family(name, type, help);
    sample(value);
  }
  std::string take() { return std::move(text_); }

private:
  static std::string escaped(std::string_view label) {
    std::string safe;
    for (const char c : label) {
      if (c == '\\' || c == '"') safe += '\\';
      safe += c == '\n' ? ' ' : c;
    }
    return safe;
  }

  std::string text_, name_;
};

void write_sensors(const health_t& health, Writer& to) {
  const std::pair<const char*, const sensor_health_t*> sensors[] = {
      {"lidar", &health.lidar}, {"imu", &health.imu}, {"encoder", &health.encoder}};
  const auto each = [&](std::string_view name, std::string_view type, std::string_view help,
                        auto&& value_of) {
    to.family(name, type, help);
    for (const auto& [sensor, state] : sensors) to.sample(value_of(*state), "sensor", sensor);
  };
  using Sensor = const sensor_health_t&;
  each("sensor_ok", "gauge", "1 while its messages come and are understood",
       [](Sensor it) { return it.state == sensor_health_t::OK ? 1.0 : 0.0; });
  each("sensor_state", "gauge", "0 never seen, 1 ok, 2 silent, 3 wrong data, 4 slow",
       [](Sensor it) { return static_cast<double>(it.state); });
  each("sensor_rate_hertz", "gauge", "messages in the last second",
       [](Sensor it) { return it.rate; });
  each("sensor_messages_total", "counter", "messages that were understood",
       [](Sensor it) { return static_cast<double>(it.messages); });
  each("sensor_lost_total", "counter", "messages missing by the sensor's own count",
       [](Sensor it) { return static_cast<double>(it.lost); });
  each("sensor_refused_total", "counter", "messages that were refused", [](Sensor it) {
    double sum = 0;
    for (const std::int64_t count : it.refused) sum += static_cast<double>(count);
    return sum;
  });
  each("sensor_clock_accuracy_seconds", "gauge", "how far off its times may be",
       [](Sensor it) { return it.clock_accuracy_ms / 1000; });
}

void write_times(std::string_view name, std::string_view help, const latency_t& time, Writer& to) {
  to.family(name, "summary", help);
  to.sample(time.p50_ms / 1000, "quantile", "0.5");
  to.sample(time.p99_ms / 1000, "quantile", "0.99");
  to.sample(time.max_ms / 1000, "quantile", "1");
}

void write_counts(const health_t& health, Writer& to) {
  struct Count {
    const char *name, *help;
    std::int64_t value;
  };
  for (const Count& each : {
           Count{"sweeps_total", "complete turns of the lidar", health.sweeps},
           {"sweeps_dropped_total", "turns dropped, the detector was busy", health.sweeps_dropped},
           {"sweeps_empty_total", "turns without any return", health.sweeps_empty},
           {"sweeps_not_covered_total", "turns without the IMU and encoder samples that cover them",
            health.sweeps_not_covered},
           {"sweeps_slipped_total", "turns during which the wheel slipped", health.sweeps_slipped},
           {"heading_resets_total", "turns of the yaw that were not believed",
            health.heading_resets},
           {"lists_published_total", "obstacle lists", health.lists_published},
           {"lists_failed_total", "lists and grids that LCM did not take", health.lists_failed},
           {"lists_dropped_total", "lists dropped, the publisher was busy", health.lists_dropped},
           {"points_dropped_total", "points without room", health.points_dropped},
           {"obstacles_dropped_total", "obstacles without room", health.obstacles_dropped},
           {"samples_dropped_total", "samples of IMU and encoder without room",
            health.samples_dropped},
           {"samples_refused_total", "samples of IMU and encoder that were refused",
            health.samples_refused},
       }) {
    to.one(each.name, "counter", each.help, static_cast<double>(each.value));
  }
}

}  // namespace

std::string metrics_text(const health_t& health) {
  Writer to;
  to.family("info", "gauge", "always 1, with the version");
  to.sample(1, "version", health.version);
  to.one("health_time_seconds", "gauge", "when this was true, since the UNIX epoch",
         static_cast<double>(health.stamp_ns) * 1e-9);
  to.one("blind", "gauge", "1 while obstacles would not be seen",
         health.state == health_t::OK ? 0 : 1);
  to.one("stop", "gauge", "1 while the robot must stop", health.stop != 0 ? 1 : 0);
  to.one("settings_contradicted", "gauge", "settings that the sensors contradict",
         health.setup_size);
  write_sensors(health, to);
  write_times("latency_seconds", "from a turn's last packet to its list", health.latency, to);
  write_times("detector_seconds", "of the detector alone", health.detector_time, to);
  to.one("position_deviation_meters", "gauge", "standard deviation of the position",
         health.position_deviation);
  to.one("yaw_deviation_radians", "gauge", "standard deviation of the heading",
         health.yaw_deviation);
  to.one("processor_temperature_celsius", "gauge", "of the processor's hottest sensor",
         health.processor_temperature);
  write_counts(health, to);
  return to.take();
}

}  // namespace scree
