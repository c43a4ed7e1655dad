#include "contradiction.hpp"

#include <spdlog/fmt/fmt.h>

#include <string_view>

namespace scree {
namespace {

std::optional<Contradiction> contradiction(const DetectSettings& detect, std::string_view table) {
  const auto of = [&](std::string_view key) { return fmt::format("{}.{}", table, key); };
  constexpr double kLeastLeaf = 0.001;  // metres
  if (detect.leaf_size > 0 && detect.leaf_size < kLeastLeaf) {
    return Contradiction{{of("leaf_size")},
                         fmt::format("{} must be 0 or at least {}", of("leaf_size"), kLeastLeaf)};
  }
  if (detect.method == Method::edges && detect.edges.ground_inner >= detect.edges.ground_outer) {
    return Contradiction{
        {of("ground_inner"), of("ground_outer")},
        fmt::format("{} must be below {}", of("ground_inner"), of("ground_outer"))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Contradiction> contradiction(const Settings& settings) {
  if (settings.lidar.min_range >= settings.lidar.max_range) {
    return Contradiction{{"lidar.min_range", "lidar.max_range"},
                         "lidar.min_range must be below lidar.max_range"};
  }
  if (settings.lidar.port == settings.lidar.position_port) {
    return Contradiction{{"lidar.port", "lidar.position_port"},
                         "lidar.port and lidar.position_port must differ"};
  }
  const EncoderSettings& encoder = settings.encoder;
  constexpr int kLargestFrame = 64;
  if (encoder.frame_bytes() > kLargestFrame) {
    return Contradiction{
        {"encoder.start_bit", "encoder.length"},
        "encoder.start_bit and encoder.length reach beyond the 64 bytes of the longest frame"};
  }
  if (encoder.scale == 0) return Contradiction{{"encoder.scale"}, "encoder.scale must not be 0"};
  if (encoder.dbc.empty() != encoder.signal.empty()) {
    return Contradiction{{"encoder.dbc", "encoder.signal"},
                         "encoder.dbc and encoder.signal belong together, one of them is empty"};
  }
  if (settings.track.disappear > settings.track.appear) {
    return Contradiction{{"track.disappear", "track.appear"},
                         "track.disappear must not be above track.appear"};
  }
  auto found = contradiction(settings.detect_cloud, "detect.cloud");
  if (!found) found = contradiction(settings.detect_map, "detect.map");
  if (!found) found = contradiction(settings.detect_sweep, "detect.sweep");
  return found;
}

}  // namespace scree
