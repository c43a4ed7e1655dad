#include "bench/pcl_chain.hpp"

#include <pcl/filters/voxel_grid.h>
#include <pcl/segmentation/extract_clusters.h>

#include <Eigen/Core>
#include <cmath>

#include "scree/core/pcl_cloud.hpp"
#include "scree/detect/classification.hpp"
#include "scree/detect/label.hpp"
#include "scree/detect/quantile.hpp"

namespace scree::bench {
namespace {

using Lanes = Eigen::Array<float, 8, 1>;

pcl::PointCloud<pcl::PointXYZ>::Ptr flattened(PointView points) {
  auto plane = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  plane->reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    plane->push_back({points.x[i], points.y[i], 0.0F});
  }
  return plane;
}

struct Mean {
  float sum = 0, count = 0;
  void add(float value) {
    sum += value;
    ++count;
  }
  float value() const { return count > 0 ? sum / count : 0; }
};

}  // namespace

PclChain::PclChain(const DetectSettings& settings, std::size_t max_points, Network network)
    : settings_(settings),
      network_(std::move(network)),
      edges_(max_points),
      kept_(max_points),
      clusters_(max_points, static_cast<std::size_t>(settings.edges.min_cluster_size)),
      polygons_(max_points) {}

void PclChain::detect(const pcl::PointCloud<pcl::PointXYZI>::Ptr& cloud,
                      FixedVector<Obstacle>& obstacles) {
  thin(cloud);
  find_edges();
  suppress();
  cluster();
  measure_clusters();
  StageCounts counts;
  classify({kept_, clusters_}, network_, settings_.min_confidence, Eigen::Vector2f::Zero(),
           polygons_, obstacles, counts);
}

void PclChain::thin(const pcl::PointCloud<pcl::PointXYZI>::Ptr& cloud) {
  const auto leaf = static_cast<float>(settings_.leaf_size);
  pcl::VoxelGrid<pcl::PointXYZI> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(leaf, leaf, leaf);
  pcl::PointCloud<pcl::PointXYZI> thinned;
  grid.filter(thinned);
  points_ = from_pcl(thinned);
  plane_ = flattened(points_);
  tree_.setInputCloud(plane_);
}

/// The Sobel gradient of the kernel estimates at eight positions around each point (eq. 1-4).
void PclChain::find_edges() {
  const KernelSettings& kernel = settings_.edges.kernel;
  const auto spacing = static_cast<float>(kernel.spacing);
  const auto radius = static_cast<float>(kernel.radius);
  const float sigma = static_cast<float>(kernel.bandwidth) * radius;
  const float decay = -1 / (2 * sigma * sigma);
  const auto threshold = static_cast<float>(settings_.edges.threshold);
  Lanes offset_x, offset_y, sobel_x, sobel_y;
  offset_x << -1, 0, 1, -1, 1, -1, 0, 1;
  offset_y << -1, -1, -1, 0, 0, 1, 1, 1;
  sobel_x << -1, 0, 1, -2, 2, -1, 0, 1;
  sobel_y << -1, -2, -1, 0, 0, 1, 2, 1;
  offset_x *= spacing;
  offset_y *= spacing;
  const float reach = std::sqrt(2.0F) * spacing + radius;
  pcl::Indices near;
  std::vector<float> squares;
  is_edge_.assign(points_.size(), 0);
  edges_.clear();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    tree_.radiusSearch(static_cast<int>(i), reach, near, squares);
    Lanes weights = Lanes::Zero(), heights = Lanes::Zero(), counts = Lanes::Zero();
    for (const int index : near) {
      const auto j = static_cast<std::size_t>(index);
      const Lanes dx = points_.x[j] - points_.x[i] - offset_x;
      const Lanes dy = points_.y[j] - points_.y[i] - offset_y;
      const Lanes square = dx * dx + dy * dy;
      const Lanes inside = (square <= radius * radius).cast<float>();
      const Lanes weight = inside * (square * decay).exp();
      weights += weight;
      heights += weight * (points_.z[j] - points_.z[i]);
      counts += inside;
    }
    if (counts.minCoeff() < static_cast<float>(kernel.neighbours)) continue;
    const Lanes estimates = heights / weights;
    const float slope_x = (sobel_x * estimates).sum() / (8 * spacing);
    const float slope_y = (sobel_y * estimates).sum() / (8 * spacing);
    if (slope_x * slope_x + slope_y * slope_y < threshold * threshold) continue;
    is_edge_[i] = 1;
    edges_.push_back(points_, i, slope_x, slope_y);
  }
}

/// Keeps the edges that are steepest along their gradient (fig. 4).
void PclChain::suppress() {
  const auto distance = static_cast<float>(settings_.edges.suppression_distance);
  const auto radius = static_cast<float>(settings_.edges.suppression_radius);
  Tree tree(false);
  tree.setInputCloud(flattened(edges_.points));
  std::vector<float> slopes(edges_.size());
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    slopes[i] = std::hypot(edges_.slope_x[i], edges_.slope_y[i]);
  }
  pcl::Indices near;
  std::vector<float> squares;
  kept_.clear();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    tree.radiusSearch(static_cast<int>(i), distance / 2 + radius, near, squares);
    const float half = distance / (2 * slopes[i]);
    const float step_x = edges_.slope_x[i] * half, step_y = edges_.slope_y[i] * half;
    Mean above, below;
    for (const int index : near) {
      const auto j = static_cast<std::size_t>(index);
      const float dx = edges_.points.x[j] - edges_.points.x[i];
      const float dy = edges_.points.y[j] - edges_.points.y[i];
      const auto is_within = [&](float x, float y) { return x * x + y * y <= radius * radius; };
      if (is_within(dx - step_x, dy - step_y)) above.add(slopes[j]);
      if (is_within(dx + step_x, dy + step_y)) below.add(slopes[j]);
    }
    if (slopes[i] < above.value() || slopes[i] < below.value()) continue;
    kept_.push_back(edges_.points, i, edges_.slope_x[i], edges_.slope_y[i]);
  }
}

void PclChain::cluster() {
  const auto cloud = std::make_shared<Flat>();
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    cloud->push_back({kept_.points.x[i], kept_.points.y[i], kept_.points.z[i]});
  }
  const auto tree = std::make_shared<Tree>(false);
  tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setInputCloud(cloud);
  extraction.setSearchMethod(tree);
  extraction.setClusterTolerance(settings_.edges.cluster_tolerance);
  extraction.setMinClusterSize(settings_.edges.min_cluster_size);
  std::vector<pcl::PointIndices> groups;
  extraction.extract(groups);
  labels_.assign(kept_.size(), kNoLabel);
  sizes_.clear();
  for (const pcl::PointIndices& group : groups) {
    for (const int i : group.indices) {
      labels_[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(sizes_.size());
    }
    sizes_.push_back(static_cast<std::uint32_t>(group.indices.size()));
  }
  clusters_.gather(kept_, labels_, sizes_,
                   static_cast<std::uint32_t>(settings_.edges.min_cluster_size));
}

void PclChain::measure_clusters() {
  for (Cluster& cluster : clusters_.all()) {
    const auto members = clusters_.members(cluster);
    cluster.ground = ground_around(cluster.box, (cluster.lowest + cluster.highest) / 2);
    for (const std::uint32_t i : members) kept_.height[i] = kept_.points.z[i] - cluster.ground;
    cluster.features = measure(kept_, members);
    cluster.evidence = Evidence::inside;
  }
}

/// The median height of what is no edge in a ring around a box, which widens until it has enough.
float PclChain::ground_around(const OrientedBox& box, float otherwise) {
  constexpr std::size_t kEnough = 8;
  constexpr int kWidenings = 4;
  const auto inner = static_cast<float>(settings_.edges.ground_inner);
  auto outer = static_cast<float>(settings_.edges.ground_outer);
  const auto distance_of = box.distances();
  pcl::Indices near;
  std::vector<float> squares, heights;
  for (int widening = 0; widening < kWidenings; ++widening, outer *= 2) {
    const double reach = std::hypot(box.length, box.width) / 2 + outer;
    tree_.radiusSearch(pcl::PointXYZ(box.center_x, box.center_y, 0), reach, near, squares);
    heights.clear();
    for (const int index : near) {
      const auto i = static_cast<std::size_t>(index);
      const float distance = distance_of(points_.x[i], points_.y[i]);
      if (is_edge_[i] == 0 && distance >= inner && distance <= outer) {
        heights.push_back(points_.z[i]);
      }
    }
    if (heights.size() >= kEnough) return quantile(heights, 0.5);
  }
  return otherwise;
}

}  // namespace scree::bench
