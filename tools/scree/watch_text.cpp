#include "watch_text.hpp"

#include <spdlog/fmt/fmt.h>

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

const char* lidar_state(std::int8_t state) {
  switch (state) {
    case lidar_health_t::NEVER_SEEN:
      return "never seen";
    case lidar_health_t::OK:
      return "ok";
    case lidar_health_t::SILENT:
      return "silent";
    case lidar_health_t::WRONG_DATA:
      return "wrong data";
    default:
      return "in an unknown state";
  }
}

void append_counts(const health_t& health, std::string& text) {
  std::string counts;
  const auto add = [&](const std::string& what, std::int64_t count) {
    if (count != 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", what, count);
  };
  add("packets lost", health.lidar.lost_packets);
  add("dropped by the kernel", health.lidar.kernel_drops);
  for (std::size_t i = 0; i < health.lidar.refused.size(); ++i) {
    add("refused for " + health.lidar.refused_reason[i], health.lidar.refused[i]);
  }
  add("sweeps dropped", health.sweeps_dropped);
  add("lists failed", health.lists_failed);
  add("lists dropped", health.lists_dropped);
  add("points dropped", health.points_dropped);
  add("edge points dropped", health.edge_points_dropped);
  add("obstacles dropped", health.obstacles_dropped);
  if (!counts.empty()) text += fmt::format("              {}\n", counts);
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
  fmt::format_to(std::back_inserter(text),
                 "{}  health {}: lidar {}{}{}, {:.0f} packets/s, {} sweeps, {} lists, latency p50 "
                 "{:.1f} p99 {:.1f} max {:.1f} ms\n",
                 time_of_day(health.stamp_ns), state, lidar_state(health.lidar.state),
                 health.lidar.sender.empty() ? "" : " from ", health.lidar.sender,
                 health.lidar.packet_rate, health.sweeps, health.lists_published,
                 health.latency.p50_ms, health.latency.p99_ms, health.latency.max_ms);
  if (health.stop != 0) text += "              stop\n";
  if (!health.lines_problem.empty()) text += "              " + health.lines_problem + '\n';
  append_counts(health, text);
}

}  // namespace scree::cli
