#include "live/top_page.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "live/health_words.hpp"
#include "scree/core/pose.hpp"

namespace scree::cli {
namespace {

constexpr double kSilent = 3;    // seconds without health, which comes once a second
constexpr double kNoLists = 1;   // seconds without lists, which come at least 5 times a second
constexpr int kTimesWidth = 38;  // columns
constexpr int kQueuesWidth = 28;
constexpr int kTableWidth = 58;
constexpr int kLeastPlot = 16;

/// Pieces of a part of the terminal; what goes beyond it is cut off.
class Area {
public:
  Area(Page& page, int row, int column, int rows, int columns)
      : page_(page), row_(row), column_(column), rows_(rows), columns_(columns) {}

  int rows_left() const { return rows_ - used_; }
  /// A new row.
  void add(std::string text, Tone tone = Tone::plain) {
    if (rows_left() <= 0 || columns_ <= 0) return;
    if (text.size() > static_cast<std::size_t>(columns_))
      text.resize(static_cast<std::size_t>(columns_));
    page_.push_back({row_ + used_++, column_, std::move(text), tone});
  }

private:
  Page& page_;
  int row_, column_, rows_, columns_, used_ = 0;
};

Tone tone_of(std::int8_t sensor_state) {
  if (sensor_state == sensor_health_t::OK) return Tone::good;
  return sensor_state == sensor_health_t::SLOW ? Tone::warning : Tone::bad;
}

void add_header(const TopView& view, Area& area) {
  if (view.refused > 0) {
    area.add(fmt::format("{} messages are malformed, or of another version of Scree", view.refused),
             Tone::warning);
  }
  if (!view.health) {
    area.add(fmt::format("scree top  no health yet for {:.0f} s on {}", view.waited, view.url),
             Tone::bad);
    area.add("does screed run, and with the same lcm.url?");
    return;
  }
  const health_t& health = *view.health;
  const bool is_blind = health.state != health_t::OK, is_silent = view.health_age >= kSilent;
  const std::string title =
      fmt::format("screed {}  {}  {}{}", health.version, time_of_day(health.stamp_ns).substr(0, 8),
                  is_blind ? "BLIND" : "SEES", health.stop != 0 ? "  STOP" : "");
  if (is_silent) {
    area.add(fmt::format("no health for {:.0f} s on {}; the last:", view.health_age, view.url),
             Tone::bad);
    area.add(title);
    return;
  }
  area.add(title, is_blind ? Tone::bad : health.stop != 0 ? Tone::warning : Tone::good);
  const std::string setup = health.setup.empty() ? health.lines_problem : health.setup.front();
  area.add(health.reason.empty() ? setup : health.reason, Tone::bad);
}

void add_sensor(const char* name, const sensor_health_t& sensor, std::string_view state,
                Area& area) {
  std::int64_t refused = 0;
  for (const std::int64_t count : sensor.refused) refused += count;
  area.add(fmt::format("{:<8}{:<11}{:>5.0f}/{:<5.0f}{:>6}{:>8}  {:<14}{:>7.2f}{:>11.3f}  {}", name,
                       state, sensor.rate, sensor.expected_rate, sensor.lost + sensor.kernel_drops,
                       refused, clock_name(sensor.clock), sensor.clock_accuracy_ms,
                       sensor.clock_offset_s, sensor.source),
           state == kOff ? Tone::plain : tone_of(sensor.state));
}

bool knows_pose(const health_t& health) {
  return !std::isnan(health.position_deviation);
}

void add_sensors(const health_t& health, Area& area) {
  area.add(fmt::format("{:<8}{:<11}{:>5}/{:<5}{:>6}{:>8}  {:<14}{:>7}{:>11}  {}", "SENSOR", "state",
                       "rate", "due", "lost", "refused", "clock", "to ms", "offset s", "source"),
           Tone::heading);
  add_sensor("lidar", health.lidar, state_name(health.lidar.state), area);
  add_sensor("imu", health.imu, optional_state_name(health.imu), area);
  add_sensor("encoder", health.encoder, optional_state_name(health.encoder), area);
  if (!knows_pose(health)) return;
  area.add(fmt::format("pose    off by {:.2f} m and {:.2f} deg (one standard deviation)",
                       health.position_deviation, degrees(health.yaw_deviation)));
}

/// Latency and the detector's stages, the slowest first.
void add_times(const health_t& health, Area& area) {
  const auto add = [&](const std::string& name, const latency_t& time) {
    area.add(
        fmt::format("{:<14}{:>7.1f}{:>7.1f}{:>8.1f}", name, time.p50_ms, time.p99_ms, time.max_ms));
  };
  area.add(fmt::format("{:<14}{:>7}{:>7}{:>8}", "TIME, ms", "p50", "p99", "max"), Tone::heading);
  add("latency", health.latency);
  add("detector", health.detector_time);
  std::vector<stage_t> stages = health.stages;
  std::ranges::stable_sort(stages, std::greater(),
                           [](const stage_t& stage) { return stage.time.p99_ms; });
  for (const stage_t& stage : stages) add("  " + stage.name, stage.time);
}

void add_queues(const health_t& health, Area& area) {
  area.add(fmt::format("{:<8}{:>5}{:>6}{:>6}", "QUEUE", "now", "most", "of"), Tone::heading);
  for (const queue_t& queue : health.queues) {
    area.add(
        fmt::format("{:<8}{:>5}{:>6}{:>6}", queue.name, queue.waiting, queue.most, queue.capacity),
        queue.most >= queue.capacity ? Tone::warning : Tone::plain);
  }
  if (!std::isnan(health.processor_temperature)) {
    area.add(fmt::format("processor {:.1f} C", health.processor_temperature));
  }
  area.add(fmt::format("{:<11}{:>7}{:>7}", "PAGE FAULTS", "minor", "major"), Tone::heading);
  for (const thread_t& thread : health.threads) {
    area.add(
        fmt::format("{:<11}{:>7}{:>7}", thread.name, thread.minor_faults, thread.major_faults));
  }
}

/// What was lost, refused and dropped, by reason.
void add_losses(const health_t& health, Area& area) {
  area.add("LOSSES", Tone::heading);
  const auto add = [&](const char* whose, const Counts& counts) {
    for (const auto& [what, count] : counts) {
      area.add(fmt::format("{} {}{}", count, whose, what), Tone::warning);
    }
  };
  add("lidar ", losses_of(health.lidar));
  add("imu ", losses_of(health.imu));
  add("encoder ", losses_of(health.encoder));
  add("", drops_of(health));
}

const char* word_for(const Obstacle& obstacle) {
  if (obstacle.evidence == Evidence::edge) return "edge";
  return obstacle.kind == ObstacleKind::positive ? "rock" : "hole";
}

std::string bearing(const Sighting& sighting) {
  const double bearing = degrees(std::atan2(sighting.left, sighting.ahead));
  return fmt::format("{:.0f} {}", std::abs(bearing), bearing < 0 ? 'R' : 'L');
}

void add_obstacles(const TopView& view, const std::vector<Sighting>& obstacles, Area& area) {
  if (!view.list || view.list_age >= kNoLists) {
    area.add(view.list ? fmt::format("NO LIST for {:.0f} s", view.list_age) : "NO LIST yet",
             Tone::bad);
    return;
  }
  area.add(fmt::format("{:<6}{:<5}{:>7}{:>7}{:>14}{:>9}{:>9}", "ID", "kind", "dist m", "at deg",
                       "size m", "height m", "conf."),
           Tone::heading);
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& one = *obstacles[i].obstacle;
    if (area.rows_left() == 1 && i + 1 < obstacles.size()) {
      area.add(fmt::format("and {} farther off", obstacles.size() - i));
      return;
    }
    area.add(fmt::format("{:<6}{:<5}{:>7.2f}{:>7}{:>14}{:>9.2f}{:>9.2f}", one.id, word_for(one),
                         obstacles[i].distance, bearing(obstacles[i]),
                         fmt::format("{:.2f} x {:.2f}", one.extent.x(), one.extent.y()), one.height,
                         one.confidence));
  }
  if (obstacles.empty()) area.add("nothing there", Tone::good);
}

/// Rows of times, queues and losses side by side: all that is there, as far as obstacles keep some.
int work_rows(const health_t& health, int rows_left) {
  constexpr int kLeastObstacles = 9, kLeastWork = 4;
  const int wanted = 3 + static_cast<int>(std::max(health.stages.size(),
                                                   health.queues.size() + health.threads.size()));
  const int work = std::min(wanted, rows_left - kLeastObstacles);
  return work < std::min(kLeastWork, wanted) ? 0 : work;
}

}  // namespace

Page top_page(const TopView& view, int rows, int columns) {
  constexpr int kHeader = 2;  // rows
  Page page;
  Area header(page, 0, 0, std::min(rows, kHeader), columns);
  add_header(view, header);
  int row = kHeader;
  const int sensor_rows = view.health && knows_pose(*view.health) ? 5 : 4;
  if (view.health && rows > kHeader + sensor_rows + 1) {
    Area sensors(page, row, 0, sensor_rows, columns);
    add_sensors(*view.health, sensors);
    row += sensor_rows + 1;
    const int work = work_rows(*view.health, rows - row);
    if (work > 0) {
      Area times(page, row, 0, work, std::min(columns, kTimesWidth - 1));
      add_times(*view.health, times);
      Area queues(page, row, kTimesWidth, work, std::min(columns - kTimesWidth, kQueuesWidth - 1));
      add_queues(*view.health, queues);
      const int losses_from = kTimesWidth + kQueuesWidth;
      Area losses(page, row, losses_from, work, columns - losses_from);
      add_losses(*view.health, losses);
      row += work + 1;
    }
  }
  const std::vector<Sighting> obstacles =
      view.list ? sightings(*view.list) : std::vector<Sighting>();
  const bool has_plot =
      columns - kTableWidth >= kLeastPlot && view.list && view.list_age < kNoLists;
  Area table(page, row, 0, rows - row, has_plot ? kTableWidth - 1 : columns);
  add_obstacles(view, obstacles, table);
  if (!has_plot) return page;
  constexpr double kReach = 12;  // metres
  const int plot_columns = columns - kTableWidth;
  Area picture(page, row, kTableWidth, rows - row, plot_columns);
  for (std::string& line : plot(obstacles, kReach, rows - row, plot_columns))
    picture.add(std::move(line));
  return page;
}

}  // namespace scree::cli
