#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <cstdint>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/enclosing_polygon.hpp"
#include "scree/detect/network.hpp"

namespace scree::bench {

/// The paper's method with algorithm 1, as one would write it with PCL: its voxel grid, its
/// kd-trees for every neighbourhood, its Euclidean clustering. Each neighbourhood is searched once,
/// results are not sorted, and the eight kernel sums of a point are taken together. Boxes, F1-F5
/// and the network, which are a hundredth of the time, are Scree's own.
class PclChain {
public:
  PclChain(const DetectSettings& settings, std::size_t max_points, Network network);

  void detect(const pcl::PointCloud<pcl::PointXYZI>::Ptr& cloud, FixedVector<Obstacle>& obstacles);

private:
  using Flat = pcl::PointCloud<pcl::PointXYZ>;
  using Tree = pcl::search::KdTree<pcl::PointXYZ>;

  void thin(const pcl::PointCloud<pcl::PointXYZI>::Ptr& cloud);
  void find_edges();
  void suppress();
  void cluster();
  void measure_clusters();
  float ground_around(const OrientedBox& box, float otherwise);

  DetectSettings settings_;
  Network network_;
  PointCloud points_;
  Flat::Ptr plane_;  // the points with z = 0
  Tree tree_{false};
  std::vector<std::uint8_t> is_edge_;
  CandidatePoints edges_, kept_;
  std::vector<std::uint32_t> labels_, sizes_;
  Clusters clusters_;
  EnclosingPolygons polygons_;
};

}  // namespace scree::bench
