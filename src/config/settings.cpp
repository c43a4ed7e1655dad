#include "scree/config/settings.hpp"

#include <spdlog/fmt/fmt.h>

#include <limits>

namespace scree {

DetectSettings DetectSettings::for_paper() {
  DetectSettings detect;
  detect.method = Method::edges;
  detect.network = "network_paper.txt";
  return detect;
}

DetectSettings DetectSettings::for_cloud() {
  DetectSettings detect;
  detect.surface.clustering = SurfaceClustering::regions;
  detect.min_confidence = 0.8;  // without beams grass looks like stones
  detect.network = "network_cloud.txt";
  return detect;
}

DetectSettings DetectSettings::for_map() {
  DetectSettings detect;
  detect.leaf_size = 0;  // the map's points are voxels
  detect.surface.ground_trend = 2;
  detect.surface.clustering = SurfaceClustering::regions;
  detect.surface.cluster_tolerance = 0.30;
  detect.network = "network_map.txt";
  detect.min_confidence = 0.05;
  return detect;
}

// A ring of a single sweep is dense and the next ring far off: the kernel reaches from ring to
// ring, weighs the nearest points most, and what is steep is too little to be thinned further.
DetectSettings DetectSettings::for_sweep() {
  DetectSettings detect = for_paper();
  detect.leaf_size = 0.05;
  EdgeSettings& edges = detect.edges;
  edges.kernel = {.spacing = 0.20, .radius = 0.60, .bandwidth = 0.20, .neighbours = 1};
  edges.threshold = 0.25;
  edges.suppression = false;
  edges.voxel_size = 0.10;
  edges.seed_distance = 0.30;
  edges.min_block_points = 3;
  edges.cluster_tolerance = 0.50;
  edges.min_cluster_size = 2;
  edges.ground_outer = 1.5;
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
