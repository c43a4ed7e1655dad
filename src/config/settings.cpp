#include "scree/config/settings.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>

namespace scree {

// A ring of a single sweep is dense and the next ring far off: the kernel reaches from ring to
// ring, weighs the nearest points most, and what is steep is too little to be thinned further.
DetectSettings DetectSettings::for_cloud() {
  DetectSettings detect;
  detect.ground = GroundReference::surface;
  detect.candidates = Candidates::bodies;
  detect.suppression = false;
  detect.cluster_method = ClusterMethod::euclidean;
  detect.cluster_tolerance = 0.20;
  detect.min_cluster_size = 4;
  detect.network = "network_cloud.txt";
  return detect;
}

DetectSettings DetectSettings::for_map() {
  DetectSettings detect = for_cloud();
  detect.max_points = MapSettings().max_voxels;
  detect.max_edge_points = 1 << 17;
  detect.max_obstacles = 512;
  detect.voxel_grid = false;
  detect.ground_trend = 2;
  detect.kernel_shared = 0.03;
  detect.cluster_method = ClusterMethod::regions;
  detect.cluster_tolerance = 0.30;
  detect.network = "network_map.txt";
  detect.min_confidence = 0.05;
  return detect;
}

DetectSettings DetectSettings::for_sweep() {
  DetectSettings detect;
  detect.max_points = 1 << 17;
  detect.max_edge_points = 1 << 16;
  detect.leaf_size = 0.05;
  detect.kernel_spacing = 0.20;
  detect.kernel_radius = 0.60;
  detect.kernel_bandwidth = 0.20;
  detect.edge_threshold = 0.25;
  detect.suppression = false;
  detect.voxel_size = 0.10;
  detect.seed_distance = 0.30;
  detect.min_block_points = 3;
  detect.cluster_tolerance = 0.50;
  detect.min_cluster_size = 2;
  detect.ground_outer = 1.5;
  detect.network = "network_sweep.txt";
  return detect;
}

TrackingSettings TrackingSettings::for_sweep() {
  TrackingSettings track;
  track.network.clear();
  track.least_found = 1;
  track.smoothing = 1;
  track.appear = track.disappear = track.remember = 0;
  track.reach = std::numeric_limits<double>::infinity();
  return track;
}

Result<std::filesystem::path> find_file(const std::string& name,
                                        const std::filesystem::path& config_file) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path shipped = program.parent_path().parent_path() / "share" / "scree";
  const fs::path beside = config_file.empty() ? shipped : config_file.parent_path();
  for (const fs::path& candidate : {beside / name, shipped / name}) {
    if (fs::is_regular_file(candidate, ignored)) return candidate;
  }
  return fail(
      fmt::format("cannot find {} beside the configuration file or in {}", name, shipped.string()));
}

}  // namespace scree
