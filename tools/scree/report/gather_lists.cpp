#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <optional>

#include "commands.hpp"
#include "detection/detections.hpp"
#include "live/health_json.hpp"
#include "report/gather.hpp"
#include "scoring/json_field.hpp"
#include "scree/capture/lcm_log.hpp"
#include "scree/publish/message_decoder.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/publisher.hpp"

namespace scree::cli {
namespace {

using HealthJson = nlohmann::json;

/// A number or NaN: health has null where there is none.
double number_at(const HealthJson& json, const char* pointer) {
  const HealthJson::json_pointer at(pointer);
  if (!json.contains(at) || !json[at].is_number()) return std::numeric_limits<double>::quiet_NaN();
  return json[at].get<double>();
}
std::string text_at(const HealthJson& json, const char* key) {
  const auto at = json.find(key);
  return at != json.end() && at->is_string() ? at->get<std::string>() : std::string();
}

/// What health said, message by message.
class HealthLog {
public:
  explicit HealthLog(ReportData& data) : data_(data) {}

  void take(const HealthJson& health) {
    const auto stamp_ns = health.at("stamp_ns").get<std::int64_t>();
    add_numbers(health, stamp_ns);
    const bool is_blind = text_at(health, "health") == "blind";
    state("blind", is_blind ? text_at(health, "reason") : "", stamp_ns);
    for (const char* sensor : {"lidar", "imu", "encoder"}) {
      const std::string said = health.contains(sensor) ? text_at(health[sensor], "state") : "";
      const bool is_usual = said == "ok" || said == "never seen" || said.empty();
      state(sensor, is_usual ? "" : fmt::format("{}: {}", sensor, said), stamp_ns);
    }
    std::string setup;
    if (health.contains("setup")) {
      for (const auto& each : health["setup"])
        setup += (setup.empty() ? "" : "; ") + each.get<std::string>();
    }
    state("setup", setup, stamp_ns);
    state("stop", health.value("stop", false) ? "the stop line is on" : "", stamp_ns);
    last_ = health;
    last_ns_ = stamp_ns;
  }

  bool has_any() const { return !last_.is_null(); }

  void finish() {
    for (auto& [kind, event] : open_) {
      if (!event.text.empty()) data_.add(ReportEvent{kind, event.text, event.from_ns, last_ns_});
    }
    if (!has_any()) return;
    data_.note("version of screed", text_at(last_, "version"));
    for (const char* count :
         {"sweeps", "sweeps_dropped", "sweeps_empty", "sweeps_not_covered", "sweeps_slipped",
          "heading_resets", "lists_published", "lists_failed", "lists_dropped", "points_dropped",
          "obstacles_dropped", "samples_dropped", "samples_refused"}) {
      std::string words = count;
      std::ranges::replace(words, '_', ' ');
      if (last_.contains(count)) data_.note(words, last_[count].dump());
    }
  }

private:
  void add_numbers(const HealthJson& health, std::int64_t stamp_ns) {
    struct Shown {
      const char *pointer, *name, *unit;
    };
    for (const Shown& each : {Shown{"/lidar/rate", "lidar packets", "1/s"},
                              {"/lidar/lost", "lidar packets lost, in all", ""},
                              {"/imu/rate", "IMU messages", "1/s"},
                              {"/imu/lost", "IMU messages lost, in all", ""},
                              {"/encoder/rate", "encoder frames", "1/s"},
                              {"/latency/p50_ms", "latency, half of the lists", "ms"},
                              {"/latency/p99_ms", "latency, 99 % of the lists", "ms"},
                              {"/detector_time/p99_ms", "detector, 99 % of the lists", "ms"},
                              {"/lidar/clock_accuracy_ms", "lidar's clock known to", "ms"},
                              {"/imu/clock_accuracy_ms", "IMU's clock known to", "ms"},
                              {"/position_deviation", "position, standard deviation", "m"},
                              {"/processor_temperature", "processor", "deg C"}}) {
      data_.add(each.name, each.unit, stamp_ns, number_at(health, each.pointer));
    }
  }

  /// What lasts: an event from its first word to its next one.
  void state(const std::string& kind, const std::string& text, std::int64_t now_ns) {
    const auto [at, is_new] = open_.try_emplace(kind, ReportEvent{kind, text, now_ns, now_ns});
    if (at->second.text == text) return;
    if (!at->second.text.empty())
      data_.add(ReportEvent{kind, at->second.text, at->second.from_ns, now_ns});
    at->second = {kind, text, now_ns, now_ns};
  }

  ReportData& data_;
  std::map<std::string, ReportEvent> open_;
  HealthJson last_;
  std::int64_t last_ns_ = 0;
};

/// "2?3." as five cells.
void append_cells(const JsonField& row, ObstacleGrid& grid) {
  constexpr std::string_view kSigns = "?.#v";
  std::size_t count = 0;
  for (const char c : row.text()) {
    if (c >= '0' && c <= '9') {
      count = std::min<std::size_t>(10 * count + static_cast<std::size_t>(c - '0'),
                                    grid.state.capacity() + 1);
      continue;
    }
    const std::size_t state = kSigns.find(c);
    if (state == std::string_view::npos) row.refuse("a cell is ? . # or v");
    for (std::size_t i = 0; i < std::max<std::size_t>(1, count); ++i) {
      if (!grid.state.push_back(static_cast<CellState>(state))) row.refuse("too many cells");
    }
    count = 0;
  }
}

void read_grid(const JsonField& field, ObstacleGrid& grid) {
  constexpr auto kMost = static_cast<std::int64_t>(ObstacleGrid::kMostCells);
  grid.clear();
  grid.stamp_ns = field["stamp_ns"].integer();
  grid.pose = field["pose"].pose();
  const auto origin = field["origin"].items(2);
  grid.origin = {origin[0].number(), origin[1].number()};
  grid.cell_size = field["cell_size"].number(1e-3, 1e3);
  grid.columns = static_cast<std::size_t>(field["columns"].integer(0, kMost));
  grid.rows = static_cast<std::size_t>(field["rows"].integer(0, kMost));
  for (const JsonField& row : field["states"].items()) append_cells(row, grid);
  if (grid.state.size() != grid.cells())
    field["states"].refuse("not as many cells as columns and rows say");
  const auto ground = field["ground"].items();
  std::size_t next = 0;
  for (const CellState state : grid.state) {
    if (state == CellState::unknown) {
      grid.ground.push_back(ObstacleGrid::kNoGround);
      continue;
    }
    if (next == ground.size()) field["ground"].refuse("too few heights");
    grid.ground.push_back(static_cast<std::int16_t>(ground[next++].integer(-32767, 32767)));
  }
}

/// Lists have no other ground than that of their grids.
void add_with_ground(const ObstacleGrid& grid, ReportData& data) {
  data.ground().add(grid);
  data.add(grid);
}

/// Calls take(object) for each line of JSON; a fault names file and line.
void for_each_line(const std::filesystem::path& file,
                   const std::function<void(const nlohmann::json&)>& take) {
  std::ifstream stream(file);
  if (!stream) throw Failure("cannot read " + file.string());
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (is_blank_end(stream, line, number)) break;
    try {
      take(parse_json(line));
    } catch (const JsonFault& fault) {
      throw Failure(fmt::format("{}:{}: {}", file.string(), number, fault.what()));
    } catch (const nlohmann::json::exception& fault) {
      throw Failure(fmt::format("{}:{}: {}", file.string(), number, fault.what()));
    }
  }
}

void gather_log(const std::filesystem::path& file, HealthLog& health, ReportData& data) {
  LcmLogReader log = value_or_fail(LcmLogReader::open(file));
  ObstacleGrid grid;
  MessageDecoder decoder(
      [](const obstacle_list_t&) {},
      [&](const health_t& message) { health.take(HealthJson::parse(health_json(message))); },
      [&](const grid_t& message) {
        if (from_message(message, grid)) add_with_ground(grid, data);
      });
  for (LcmEvent event; log.next(event);) decoder.take(event.channel, event.message);
}

}  // namespace

bool holds_lists(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) return false;
  if (is_lcm_log(file)) {
    LcmLogReader log = value_or_fail(LcmLogReader::open(file));
    for (LcmEvent event; log.next(event);) {
      if (event.channel == kObstaclesChannel || event.channel == kHealthChannel) return true;
    }
    return false;
  }
  std::ifstream stream(file);
  return stream.peek() == '{';
}

void gather_lists(const std::filesystem::path& lists, const std::filesystem::path& grids,
                  ReportData& data) {
  for (const ObstacleList& list : read_detections(lists)) data.add(list);
  HealthLog health(data);
  if (is_lcm_log(lists)) {
    gather_log(lists, health, data);
  } else {
    for_each_line(lists, [&](const nlohmann::json& line) {
      if (line.contains("health")) health.take(line);
    });
  }
  health.finish();
  if (!grids.empty()) {
    ObstacleGrid grid;
    for_each_line(grids, [&](const nlohmann::json& line) {
      read_grid(JsonField(line), grid);
      add_with_ground(grid, data);
    });
  }
  if (data.lists().empty()) throw Failure(lists.string() + " holds no obstacle list");
  if (!health.has_any())
    data.find_gaps(data.lists().front().stamp_ns, data.lists().back().stamp_ns);
}

}  // namespace scree::cli
