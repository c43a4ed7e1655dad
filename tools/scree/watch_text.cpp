#include "watch_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace scree::cli {
namespace {

std::string time_of_day(std::int64_t stamp_ns) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t in_day = (stamp_ns % (86400 * kSecond) + 86400 * kSecond) % (86400 * kSecond);
  const std::int64_t seconds = in_day / kSecond;
  return fmt::format("{:02}:{:02}:{:02}.{:03}", seconds / 3600, seconds / 60 % 60, seconds % 60,
                     in_day % kSecond / 1'000'000);
}

const char* state_name(std::int8_t state) {
  constexpr std::array kNames = {"never seen", "ok", "silent", "wrong data", "slow"};
  const auto index = static_cast<std::uint8_t>(state);
  return index < kNames.size() ? kNames[index] : "in an unknown state";
}

/// Counts that are not 0, as "lost 3, refused for size 7".
class Counts {
public:
  void add(const std::string& what, std::int64_t count) {
    if (count != 0) text_ += fmt::format("{}{} {}", text_.empty() ? "" : ", ", what, count);
  }
  const std::string& text() const { return text_; }

private:
  std::string text_;
};

std::string clock_text(const sensor_health_t& sensor) {
  if (sensor.clock == sensor_health_t::UNSYNCHRONISED) return "clock unsynchronised";
  const char* how = sensor.clock == sensor_health_t::PPS_LOCKED ? "PPS-locked" : "estimated";
  return fmt::format("clock {} to {:.3f} ms", how, sensor.clock_accuracy_ms);
}

void append_sensor(const char* name, const sensor_health_t& sensor, const std::string& note,
                   std::string& text) {
  text += fmt::format("              {} {}", name, state_name(sensor.state));
  if (!sensor.source.empty()) text += " (" + sensor.source + note + ")";
  if (sensor.messages > 0) {
    text += fmt::format(", {:.0f} of {:.0f}/s, {}", sensor.rate, sensor.expected_rate,
                        clock_text(sensor));
  }
  Counts counts;
  counts.add("lost", sensor.lost);
  counts.add("dropped by the kernel", sensor.kernel_drops);
  for (std::size_t i = 0; i < sensor.refused.size(); ++i) {
    counts.add("refused for " + sensor.refused_reason[i], sensor.refused[i]);
  }
  text += (counts.text().empty() ? "" : "; " + counts.text()) + '\n';
}

void append_dropped(const health_t& health, std::string& text) {
  Counts counts;
  counts.add("sweeps dropped", health.sweeps_dropped);
  counts.add("sweeps without a return", health.sweeps_empty);
  counts.add("lists failed", health.lists_failed);
  counts.add("lists dropped", health.lists_dropped);
  counts.add("points dropped", health.points_dropped);
  counts.add("points refused", health.points_refused);
  counts.add("edge points dropped", health.edge_points_dropped);
  counts.add("obstacles dropped", health.obstacles_dropped);
  counts.add("map points dropped", health.map_points_dropped);
  counts.add("tracks dropped", health.tracks_dropped);
  counts.add("samples dropped", health.samples_dropped);
  counts.add("samples refused", health.samples_refused);
  if (!counts.text().empty()) text += "              " + counts.text() + '\n';
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

}  // namespace

void append_text(const ObstacleList& list, std::string& text) {
  fmt::format_to(std::back_inserter(text), "{}  {} obstacle{}\n", time_of_day(list.stamp_ns),
                 list.obstacles.size(), list.obstacles.size() == 1 ? "" : "s");
  for (const Obstacle& obstacle : list.obstacles) {
    fmt::format_to(std::back_inserter(text),
                   "  #{:<4} {} at x {:6.2f} y {:6.2f} m, {} {:.2f} m, {:.2f} x {:.2f} m, "
                   "confidence {:.2f}, {} points\n",
                   obstacle.id, name(obstacle.kind), obstacle.center.x(), obstacle.center.y(),
                   obstacle.kind == ObstacleKind::positive ? "height" : "depth ",
                   std::abs(obstacle.height), obstacle.extent.x(), obstacle.extent.y(),
                   obstacle.confidence, obstacle.points);
  }
}

void append_text(const health_t& health, std::string& text) {
  const std::string state =
      health.state == health_t::OK ? std::string("ok") : "BLIND (" + health.reason + ")";
  fmt::format_to(
      std::back_inserter(text),
      "{}  health {}{}: {} sweeps, {} lists, latency p50 {:.1f} p99 {:.1f} max {:.1f} ms\n",
      time_of_day(health.stamp_ns), state, health.stop != 0 ? ", stop" : "", health.sweeps,
      health.lists_published, health.latency.p50_ms, health.latency.p99_ms, health.latency.max_ms);
  append_sensor("lidar", health.lidar, "", text);
  append_sensor("imu", health.imu, "", text);
  append_sensor("encoder", health.encoder, ", bus " + health.encoder_bus, text);
  if (!health.lines_problem.empty()) text += "              " + health.lines_problem + '\n';
  append_work(health, text);
  append_dropped(health, text);
}

}  // namespace scree::cli
