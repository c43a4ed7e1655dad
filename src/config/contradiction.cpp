#include "contradiction.hpp"

#include <spdlog/fmt/fmt.h>

#include <string_view>
#include <utility>

namespace scree {
namespace {

void find(const DetectSettings& detect, std::string_view table, std::vector<Contradiction>& found) {
  const auto of = [&](std::string_view key) { return fmt::format("{}.{}", table, key); };
  constexpr double kLeastLeaf = 0.001;  // metres
  if (detect.leaf_size > 0 && detect.leaf_size < kLeastLeaf) {
    found.push_back({{of("leaf_size")},
                     fmt::format("{} must be 0 or at least {}", of("leaf_size"), kLeastLeaf)});
  }
  if (detect.method == Method::edges && detect.edges.ground_inner >= detect.edges.ground_outer) {
    found.push_back({{of("ground_inner"), of("ground_outer")},
                     fmt::format("{} must be below {}", of("ground_inner"), of("ground_outer"))});
  }
}

/// The stop zone is of no use where the lidar is not listened to.
void find_blind_stop_zone(const Settings& settings, std::vector<Contradiction>& found) {
  constexpr double kLeast = 0.3;   // metres of the zone that are left
  constexpr double kNoZone = 0.5;  // metres: a zone as short is how one does without
  const double length = settings.stop.length;
  if (length <= kNoZone) return;
  if (settings.lidar.max_range < length) {
    found.push_back({{"lidar.max_range", "stop.length"},
                     "lidar.max_range ends before the stop zone does (stop.length)"});
  }
  if (settings.lidar.min_range > length) {
    found.push_back({{"lidar.min_range", "stop.length"},
                     "lidar.min_range begins behind the stop zone (stop.length)"});
  }
  for (const BodyBox& box : settings.robot.body) {
    const bool is_ahead = box.low.y() < 0 && box.high.y() > 0 && box.low.z() < 1;
    if (!is_ahead || box.high.x() < length - kLeast || box.low.x() > kLeast) continue;
    found.push_back({{"robot.body", "stop.length"},
                     "a box of robot.body covers the stop zone: nothing would be seen in it"});
  }
}

}  // namespace

std::vector<Contradiction> contradictions(const Settings& settings) {
  std::vector<Contradiction> found;
  if (settings.lidar.min_range >= settings.lidar.max_range) {
    found.push_back(
        {{"lidar.min_range", "lidar.max_range"}, "lidar.min_range must be below lidar.max_range"});
  }
  find_blind_stop_zone(settings, found);
  if (settings.lidar.port == settings.lidar.position_port) {
    found.push_back(
        {{"lidar.port", "lidar.position_port"}, "lidar.port and lidar.position_port must differ"});
  }
  const EncoderSettings& encoder = settings.encoder;
  constexpr int kLargestFrame = 64;
  if (encoder.frame_bytes() > kLargestFrame) {
    found.push_back(
        {{"encoder.start_bit", "encoder.length"},
         "encoder.start_bit and encoder.length reach beyond the 64 bytes of the longest frame"});
  }
  if (encoder.scale == 0) found.push_back({{"encoder.scale"}, "encoder.scale must not be 0"});
  if (encoder.dbc.empty() != encoder.signal.empty()) {
    found.push_back({{"encoder.dbc", "encoder.signal"},
                     "encoder.dbc and encoder.signal belong together, one of them is empty"});
  }
  constexpr std::size_t kLongestInterface = 15;  // IFNAMSIZ, less the zero
  if (encoder.interface.size() > kLongestInterface) {
    found.push_back({{"encoder.interface"},
                     "encoder.interface is longer than the 15 letters of any interface's name"});
  }
  const GpioSettings& gpio = settings.gpio;
  if (!gpio.stop.empty() && gpio.stop == gpio.heartbeat) {
    found.push_back(
        {{"gpio.stop", "gpio.heartbeat"}, "gpio.stop and gpio.heartbeat must be different lines"});
  }
  for (const auto& [key, path] : {std::pair{"blackbox.folder", settings.blackbox.folder},
                                  {"metrics.file", settings.metrics.file}}) {
    if (!path.empty() && !path.starts_with('/')) {
      found.push_back({{key},
                       fmt::format("{} must begin with / : nobody knows where screed is "
                                   "started",
                                   key)});
    }
  }
  const int lists = settings.detect.lists_per_turn;
  if (lists != 1 && lists != 2 && lists != 4 && lists != 8) {
    found.push_back({{"detect.lists_per_turn"}, "detect.lists_per_turn must be 1, 2, 4 or 8"});
  }
  if (settings.track.disappear > settings.track.appear) {
    found.push_back(
        {{"track.disappear", "track.appear"}, "track.disappear must not be above track.appear"});
  }
  find(settings.detect_cloud, "detect.cloud", found);
  find(settings.detect_map, "detect.map", found);
  find(settings.detect_sweep, "detect.sweep", found);
  return found;
}

}  // namespace scree
