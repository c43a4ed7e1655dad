#include "stages.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "commands.hpp"
#include "scree/capture/pcd.hpp"

namespace scree::cli {
namespace {

/// The given points, with a value of our own in place of the reflectivity; NaN leaves a point out.
template <class Value>
PointCloud with_value(PointView points, Value&& value) {
  PointCloud cloud(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto own = static_cast<float>(value(i));
    if (!std::isnan(own)) cloud.push_back(points.x[i], points.y[i], points.z[i], own);
  }
  return cloud;
}

PointCloud with_slope(const EdgePoints& edges) {
  return with_value(edges.points,
                    [&](std::size_t i) { return std::hypot(edges.slope_x[i], edges.slope_y[i]); });
}

}  // namespace

void write_stages(const Detector& detector, PointView input, const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Failure("cannot make the folder " + folder.string());
  const auto write = [&](const char* name, PointView cloud) {
    if (const auto written = write_pcd(folder / name, cloud); !written) {
      throw Failure(written.error().message);
    }
  };
  const EdgePoints& kept = detector.kept();
  const Clusters& clusters = detector.clusters();
  PointCloud clustered(kept.size());
  float number = 0;
  for (const Cluster& cluster : clusters.all()) {
    ++number;
    for (const std::uint32_t i : clusters.members(cluster)) {
      clustered.push_back(kept.points.x[i], kept.points.y[i], kept.points.z[i], number);
    }
  }
  write("0_input.pcd", input);
  write("1_voxel_grid.pcd", detector.thinned());
  write("2_slope.pcd", with_value(detector.cells().points(), [&](std::size_t i) {
          return std::hypot(detector.slope_x()[i], detector.slope_y()[i]);
        }));
  write("3_candidates.pcd", with_slope(detector.edges()));
  write("4_kept.pcd", with_slope(kept));
  if (detector.uses_supervoxels()) {
    const auto blocks = detector.supervoxels().labels();
    write("5_supervoxels.pcd", with_value(kept.points, [&](std::size_t i) {
            return blocks[i] == kNoLabel ? NAN : static_cast<float>(blocks[i] + 1);
          }));
    write("6_centers.pcd", detector.supervoxels().centers());
  }
  write("7_clusters.pcd", clustered);
}

std::string chain(const StageCounts& counts) {
  return fmt::format(
      "input {} -> voxel grid {} -> below clearance {} -> with slope {} -> candidates {} -> kept "
      "{} -> super-voxels {} "
      "-> large enough {} -> clusters {} -> obstacles {}",
      counts.input, counts.voxels, counts.below_clearance, counts.known, counts.edges, counts.kept,
      counts.blocks, counts.blocks_kept, counts.clusters, counts.obstacles);
}

}  // namespace scree::cli
