#include "scree/config/removed_keys.hpp"

#include <array>
#include <utility>

namespace scree {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

constexpr std::string_view kMethod =
    "method = \"edges\" clusters steep points, with heights above a ring around each cluster; "
    "method = \"surface\" clusters what stands above the ground's surface or lies below it";

/// The same in [detect.cloud], [detect.map] and [detect.sweep].
constexpr std::array<Replacement, 6> kOfDetectors = {{
    {"voxel_grid", "leaf_size = 0 takes the points as they are"},
    {"max_edge_points", "it follows from the sizes in [memory]"},
    {"max_obstacles", "set memory.obstacles"},
    {"max_ground_cells", "set memory.ground_cells"},
    {"ground", kMethod},
    {"candidates", kMethod},
}};

constexpr std::array<Replacement, 5> kOthers = {{
    {"detect.cloud.max_points", "set memory.cloud_points"},
    {"detect.map.max_points", "set memory.map_voxels"},
    {"detect.sweep.max_points", "set memory.sweep_points"},
    {"map.max_points", "set memory.sweep_points"},
    {"map.max_voxels", "set memory.map_voxels"},
}};

template <std::size_t kSize>
std::optional<std::string> find(const std::array<Replacement, kSize>& keys, std::string_view name) {
  for (const auto& [key, replacement] : keys) {
    if (key == name) return std::string(replacement);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> replacement_of(std::string_view name) {
  for (const std::string_view table : {"detect.cloud.", "detect.map.", "detect.sweep."}) {
    if (!name.starts_with(table)) continue;
    if (auto found = find(kOfDetectors, name.substr(table.size()))) return found;
  }
  return find(kOthers, name);
}

}  // namespace scree
