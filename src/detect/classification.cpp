#include "scree/detect/classification.hpp"

#include <algorithm>

namespace scree {
namespace {

Obstacle obstacle_of(const Cluster& cluster, const Prediction& prediction, float height) {
  const float low = std::min(cluster.lowest, cluster.ground);
  const float high = std::max(cluster.highest, cluster.ground);
  Obstacle obstacle;
  obstacle.kind = prediction.kind();
  obstacle.confidence = prediction.confidence();
  obstacle.center = {cluster.box.center_x, cluster.box.center_y, (low + high) / 2};
  obstacle.extent = {cluster.box.length, cluster.box.width, high - low};
  obstacle.yaw = cluster.box.yaw;
  obstacle.height = height;
  obstacle.points = cluster.end - cluster.begin;
  obstacle.evidence = cluster.evidence;
  return obstacle;
}

}  // namespace

void classify(const ClusteredPoints& found, const Network& network, double min_confidence,
              EnclosingPolygons& polygons, FixedVector<Obstacle>& obstacles, StageCounts& counts) {
  obstacles.clear();
  for (const Cluster& cluster : found.clusters.all()) {
    const Prediction prediction = network(cluster.features);
    if (prediction.confidence() < static_cast<float>(min_confidence)) continue;
    const bool is_positive = prediction.kind() == ObstacleKind::positive;
    const float height = cluster.features[is_positive ? max_height : min_height];
    if (is_positive ? height <= 0 : height >= 0) continue;
    if (!is_positive && cluster.evidence == Evidence::none) continue;
    ++counts.obstacles;
    Obstacle obstacle = obstacle_of(cluster, prediction, height);
    obstacle.id = static_cast<std::int64_t>(obstacles.size()) + 1;
    obstacle.footprint = polygons.around(found.points.points, found.clusters.members(cluster));
    if (!obstacles.push_back(obstacle)) ++counts.obstacles_dropped;
  }
}

}  // namespace scree
