#include "scree/detect/classification.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "scree/detect/obstacle_box.hpp"
#include "scree/detect/push_nearest.hpp"

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
  if (obstacle.kind == ObstacleKind::negative) obstacle.evidence = cluster.evidence;
  return obstacle;
}

/// The longer an edge is, the less can it be anything else.
float confidence_of(const GroundEdge& edge) {
  constexpr float kLeast = 0.5F, kSure = 2;  // metres of length that leave no doubt
  return kLeast + (1 - kLeast) * std::min(edge.box.length / kSure, 1.0F);
}

Obstacle obstacle_of(const GroundEdge& edge) {
  Obstacle obstacle;
  obstacle.kind = edge.step > 0 ? ObstacleKind::positive : ObstacleKind::negative;
  obstacle.confidence = confidence_of(edge);
  obstacle.center = {edge.box.center_x, edge.box.center_y, edge.ground + edge.step / 2};
  obstacle.extent = {edge.box.length, edge.box.width, std::abs(edge.step)};
  obstacle.yaw = edge.box.yaw;
  obstacle.height = edge.step;
  obstacle.points = edge.end - edge.begin;
  obstacle.evidence = edge.evidence;
  return obstacle;
}

/// What hangs above ground that is seen below it stands in the way, whatever else is known of it.
bool hangs(const Cluster& cluster) {
  constexpr float kGround = 0.3F;        // share of the place around it
  constexpr float kGap = 0.25F;          // metres below it
  constexpr std::uint32_t kFewest = 12;  // points: fewer may be dust
  return cluster.features[min_height] > kGap && cluster.features[ground_share] > kGround &&
         cluster.end - cluster.begin >= kFewest;
}

/// A bush or a trunk: grass does not grow so high.
bool is_tall(const Cluster& cluster) {
  constexpr float kUpright = 0.4F;       // metres from its lowest point to its highest
  constexpr float kHeight = 1.1F;        // metres
  constexpr std::uint32_t kFewest = 30;  // points
  return cluster.features[max_height] > kHeight && cluster.highest - cluster.lowest > kUpright &&
         cluster.end - cluster.begin >= kFewest;
}

/// Takes one answer for right, whatever the network says.
void overrule(float& right, float& wrong) {
  constexpr float kSure = 0.9F;
  right = std::max(right, kSure);
  wrong = std::min(wrong, 1 - kSure);
}

Prediction classify(const Cluster& cluster, const Network& network) {
  Prediction prediction = network(cluster.features);
  if (hangs(cluster) || is_tall(cluster)) {
    overrule(prediction.positive, prediction.negative);
  } else if (cluster.is_sure_hole) {
    overrule(prediction.negative, prediction.positive);
  }
  return prediction;
}

/// Whether an obstacle covers the middle of an edge and most of its length, as a hole that it is
/// the rim of.
bool covers(const Obstacle& obstacle, const Obstacle& edge) {
  constexpr double kNear = 0.3;  // metres
  return 2 * obstacle.extent.x() >= edge.extent.x() &&
         distance_to_box(obstacle, edge.center) <= kNear;
}

/// Whether an obstacle is a piece of what an edge says as a whole.
bool is_piece_of(const Obstacle& obstacle, const Obstacle& edge) {
  constexpr double kNear = 0.15;   // metres
  constexpr double kHigher = 1.5;  // a rock that stands at an edge is higher than it
  return obstacle.extent.x() < edge.extent.x() &&
         std::abs(obstacle.height) <= kHigher * std::abs(edge.height) &&
         distance_to_box(edge, obstacle.center) <= kNear;
}

/// Measures how far off an obstacle is from the robot.
auto from(const Eigen::Vector2f& robot) {
  return [place = Eigen::Vector3d(robot.x(), robot.y(), 0)](const Obstacle& obstacle) {
    return distance_to_box(obstacle, place);
  };
}

}  // namespace

void classify(const ClusteredPoints& found, const Network& network, double min_confidence,
              const Eigen::Vector2f& robot, EnclosingPolygons& polygons,
              FixedVector<Obstacle>& obstacles, StageCounts& counts) {
  obstacles.clear();
  for (const Cluster& cluster : found.clusters.all()) {
    if (cluster.is_terrace) continue;
    const Prediction prediction = classify(cluster, network);
    if (prediction.confidence() < static_cast<float>(min_confidence)) continue;
    const bool is_positive = prediction.kind() == ObstacleKind::positive;
    const float height = cluster.features[is_positive ? max_height : min_height];
    if (is_positive ? height <= 0 : height >= 0) continue;
    if (!is_positive && cluster.evidence == Evidence::none) continue;
    ++counts.obstacles;
    Obstacle obstacle = obstacle_of(cluster, prediction, height);
    obstacle.footprint = polygons.around(found.points.points, found.clusters.members(cluster));
    if (!push_nearest(obstacles, obstacle, from(robot))) ++counts.obstacles_dropped;
  }
}

void add_edges(const GroundEdges& edges, const Eigen::Vector2f& robot, EnclosingPolygons& polygons,
               FixedVector<Obstacle>& obstacles, StageCounts& counts) {
  std::size_t before = obstacles.size();
  for (const GroundEdge& edge : edges.all()) {
    Obstacle obstacle = obstacle_of(edge);
    const auto others = std::span(obstacles.data(), before);
    if (std::ranges::any_of(others, [&](const Obstacle& o) { return covers(o, obstacle); })) {
      continue;
    }
    const auto last = std::remove_if(obstacles.begin(), obstacles.begin() + before,
                                     [&](const Obstacle& o) { return is_piece_of(o, obstacle); });
    const auto gone = static_cast<std::size_t>(obstacles.begin() + before - last);
    std::copy(obstacles.begin() + before, obstacles.end(), last);
    obstacles.resize(obstacles.size() - gone);
    before -= gone;
    counts.obstacles -= gone;
    ++counts.obstacles;
    obstacle.footprint = polygons.around(edges.places(), edge.begin, edge.end);
    if (!push_nearest(obstacles, obstacle, from(robot))) ++counts.obstacles_dropped;
  }
}

}  // namespace scree
