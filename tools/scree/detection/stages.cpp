#include "detection/stages.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "commands.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/detect/label.hpp"

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

PointCloud with_slope(const CandidatePoints& edges) {
  return with_value(edges.points,
                    [&](std::size_t i) { return std::hypot(edges.slope_x[i], edges.slope_y[i]); });
}

/// Writes clouds into a folder, which is made.
class StageFolder {
public:
  explicit StageFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) throw Failure("cannot make the folder " + folder_.string());
  }

  void write(const char* name, PointView cloud) const {
    if (const auto written = write_pcd(folder_ / name, cloud); !written) {
      throw Failure(written.error().message);
    }
  }

private:
  std::filesystem::path folder_;
};

PointCloud numbered_by_cluster(const ClusteredPoints& found) {
  const PointCloud& points = found.points.points;
  PointCloud clustered(points.size());
  float number = 0;
  for (const Cluster& cluster : found.clusters.all()) {
    ++number;
    for (const std::uint32_t i : found.clusters.members(cluster)) {
      clustered.push_back(points.x[i], points.y[i], points.z[i], number);
    }
  }
  return clustered;
}

void write_supervoxels(const StageFolder& folder, const Supervoxels& supervoxels,
                       PointView points) {
  const auto blocks = supervoxels.labels();
  folder.write("5_supervoxels.pcd", with_value(points, [&](std::size_t i) {
                 return blocks[i] == kNoLabel ? NAN : static_cast<float>(blocks[i] + 1);
               }));
  folder.write("6_centers.pcd", supervoxels.centers());
}

}  // namespace

void write_stages(const Detector& detector, PointView input, const std::filesystem::path& path) {
  const StageFolder folder(path);
  const ClusteredPoints found = detector.clustered();
  folder.write("0_input.pcd", input);
  folder.write("1_voxel_grid.pcd", detector.points());
  const EdgeMethod* edges = detector.edge_method();
  if (edges != nullptr) {
    const SlopedCloud& sloped = edges->sloped();
    folder.write("2_slope.pcd", with_value(sloped.points(), [&](std::size_t i) {
                   return std::hypot(sloped.slope_x[i], sloped.slope_y[i]);
                 }));
  }
  detector.visit_method([&](const auto& method) {
    folder.write("3_candidates.pcd", with_slope(method.candidates()));
  });
  folder.write("4_kept.pcd", with_slope(found.points));
  if (edges != nullptr && edges->supervoxels() != nullptr) {
    write_supervoxels(folder, *edges->supervoxels(), found.points.points);
  }
  folder.write("7_clusters.pcd", numbered_by_cluster(found));
}

std::string chain(const StageCounts& counts) {
  return fmt::format(
      "input {} -> voxel grid {} -> below clearance {} -> with slope {} -> candidates {} -> kept "
      "{} -> super-voxels {} "
      "-> large enough {} -> clusters {} -> obstacles {}",
      counts.input, counts.voxels, counts.below_clearance, counts.known, counts.candidates,
      counts.kept, counts.blocks, counts.blocks_kept, counts.clusters, counts.obstacles);
}

}  // namespace scree::cli
