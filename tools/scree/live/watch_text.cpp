#include "live/watch_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "live/health_words.hpp"

namespace scree::cli {
namespace {

/// As "lost 3, refused for size 7".
std::string text_of(const Counts& counts) {
  std::string text;
  for (const auto& [what, count] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", what, count);
  }
  return text;
}

std::string clock_text(const sensor_health_t& sensor) {
  std::string text = fmt::format("clock {}", clock_name(sensor.clock));
  if (sensor.clock != sensor_health_t::UNSYNCHRONISED) {
    text += fmt::format(" to {:.3f} ms", sensor.clock_accuracy_ms);
  }
  return text;
}

void append_sensor(const char* name, const sensor_health_t& sensor, std::string_view state,
                   const std::string& note, std::string& text) {
  text += fmt::format("              {} {}", name, state);
  if (!sensor.source.empty()) text += " (" + sensor.source + note + ")";
  if (sensor.messages > 0) {
    text += fmt::format(", {:.0f} of {:.0f}/s, {}", sensor.rate, sensor.expected_rate,
                        clock_text(sensor));
  }
  const std::string losses = text_of(losses_of(sensor));
  text += (losses.empty() ? "" : "; " + losses) + '\n';
}

/// How long the detector takes, how full the queues have been, page faults, temperature.
void append_work(const health_t& health, std::string& text) {
  if (health.stages.empty()) return;
  const auto slowest = std::ranges::max_element(
      health.stages, {}, [](const stage_t& stage) { return stage.time.p99_ms; });
  text += fmt::format(
      "              detector p50 {:.1f} p99 {:.1f} max {:.1f} ms, slowest {} p99 {:.1f} ms",
      health.detector_time.p50_ms, health.detector_time.p99_ms, health.detector_time.max_ms,
      slowest->name, slowest->time.p99_ms);
  for (const queue_t& queue : health.queues) {
    text += fmt::format(", {} queue up to {} of {}", queue.name, queue.most, queue.capacity);
  }
  std::int64_t faults = 0;
  for (const thread_t& thread : health.threads) faults += thread.minor_faults + thread.major_faults;
  text += fmt::format(", {} page faults", faults);
  if (!std::isnan(health.processor_temperature)) {
    text += fmt::format(", processor {:.0f} C", health.processor_temperature);
  }
  text += '\n';
}

/// What a robot has to do: a screed that sees may still say stop, and then stop counts.
std::string state_and_stop(const health_t& health) {
  if (health.state != health_t::OK) return "BLIND (" + health.reason + "), stop";
  if (health.stop == 0) return "ok";
  return "ok, stop (stop counts: something is in the stop zone, or was until stop.hold ago)";
}

}  // namespace

void append_text(const ObstacleList& list, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{}  {} obstacle{}\n", time_of_day(list.stamp_ns),
                 list.obstacles.size(), list.obstacles.size() == 1 ? "" : "s");
  for (const Obstacle& obstacle : list.obstacles) {
    fmt::format_to(std::back_inserter(text),
                   "  #{:<4} {} at x {:6.2f} y {:6.2f} m, {} {:.2f} m, {:.2f} x {:.2f} m, "
                   "confidence {:.2f}, {} points{}{}\n",
                   obstacle.id, name(obstacle.kind), obstacle.center.x(), obstacle.center.y(),
                   obstacle.kind == ObstacleKind::positive ? "height" : "depth ",
                   std::abs(obstacle.height), obstacle.extent.x(), obstacle.extent.y(),
                   obstacle.confidence, obstacle.points,
                   obstacle.evidence == Evidence::none ? "" : ", evidence ",
                   obstacle.evidence == Evidence::none ? "" : name(obstacle.evidence));
  }
}

void append_text(const grid_t& grid, std::string& text) {
  const auto cells = [&](int state) { return std::ranges::count(grid.state, state); };
  fmt::format_to(std::back_inserter(text),
                 "{}  grid of {} x {} cells of {:g} m: {} free, {} occupied, {} drop, {} unknown\n",
                 time_of_day(grid.stamp_ns), grid.columns, grid.rows, grid.cell_size,
                 cells(grid_t::FREE), cells(grid_t::OCCUPIED), cells(grid_t::DROP),
                 cells(grid_t::UNKNOWN));
}

void append_text(const health_t& health, std::string& text) {
  fmt::format_to(
      std::back_inserter(text),
      "{}  health {}: {} sweeps, {} lists, latency p50 {:.1f} p99 {:.1f} max {:.1f} ms\n",
      time_of_day(health.stamp_ns), state_and_stop(health), health.sweeps, health.lists_published,
      health.latency.p50_ms, health.latency.p99_ms, health.latency.max_ms);
  append_sensor("lidar", health.lidar, state_name(health.lidar.state), "", text);
  append_sensor("imu", health.imu, optional_state_name(health.imu), "", text);
  append_sensor("encoder", health.encoder, optional_state_name(health.encoder),
                ", bus " + health.encoder_bus, text);
  for (const std::string& mistake : health.setup) text += "              " + mistake + '\n';
  if (!health.lines_problem.empty()) text += "              " + health.lines_problem + '\n';
  append_work(health, text);
  const std::string drops = text_of(drops_of(health));
  if (!drops.empty()) text += "              " + drops + '\n';
}

}  // namespace scree::cli
