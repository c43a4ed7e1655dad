#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <scree/grid_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <string>
#include <vector>

// Scree's messages as those of ROS 2. The types of ROS are template arguments, so this is compiled
// and tested where there is no ROS.

namespace scree_bridge {

inline constexpr const char* kFrame = "odom";

template <class Header>
void fill_header(std::int64_t stamp_ns, Header& header) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / kSecond);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % kSecond);
  header.frame_id = kFrame;
}

/// `base` in `odom`, as a geometry_msgs/TransformStamped.
template <class Message, class Transform>
void to_transform(const Message& message, Transform& transform) {
  fill_header(message.stamp_ns, transform.header);
  transform.child_frame_id = "base_link";
  transform.transform.translation.x = message.p[0];
  transform.transform.translation.y = message.p[1];
  transform.transform.translation.z = message.p[2];
  transform.transform.rotation.w = message.q[0];
  transform.transform.rotation.x = message.q[1];
  transform.transform.rotation.y = message.q[2];
  transform.transform.rotation.z = message.q[3];
}

/// A vision_msgs/Detection3DArray: a box and one hypothesis, "positive" or "negative", for each.
template <class Detections>
void to_detections(const scree::obstacle_list_t& list, Detections& detections) {
  fill_header(list.stamp_ns, detections.header);
  detections.detections.clear();
  for (const scree::obstacle_t& obstacle : list.obstacles) {
    auto& detection = detections.detections.emplace_back();
    detection.header = detections.header;
    detection.id = std::to_string(obstacle.id);
    auto& box = detection.bbox;
    box.center.position.x = obstacle.center[0];
    box.center.position.y = obstacle.center[1];
    box.center.position.z = obstacle.center[2];
    box.center.orientation.z = std::sin(obstacle.yaw / 2);
    box.center.orientation.w = std::cos(obstacle.yaw / 2);
    box.size.x = obstacle.extent[0];
    box.size.y = obstacle.extent[1];
    box.size.z = obstacle.extent[2];
    auto& result = detection.results.emplace_back();
    result.hypothesis.class_id = obstacle.kind == obstacle.POSITIVE ? "positive" : "negative";
    result.hypothesis.score = obstacle.confidence;
    result.pose.pose = box.center;
  }
}

/// A nav_msgs/OccupancyGrid: 0 free, 100 occupied or a drop, -1 unknown.
template <class Grid>
void to_occupancy(const scree::grid_t& grid, Grid& occupancy) {
  fill_header(grid.stamp_ns, occupancy.header);
  occupancy.info.map_load_time = occupancy.header.stamp;
  occupancy.info.resolution = static_cast<float>(grid.cell_size);
  occupancy.info.width = static_cast<std::uint32_t>(grid.columns);
  occupancy.info.height = static_cast<std::uint32_t>(grid.rows);
  occupancy.info.origin.position.x = grid.origin[0];
  occupancy.info.origin.position.y = grid.origin[1];
  occupancy.info.origin.position.z = grid.p[2];
  occupancy.info.origin.orientation.w = 1;
  occupancy.data.clear();
  for (const std::uint8_t state : grid.state) {
    const bool is_free = state == grid.FREE, is_unknown = state == grid.UNKNOWN;
    occupancy.data.push_back(static_cast<std::int8_t>(is_free ? 0 : is_unknown ? -1 : 100));
  }
}

struct Point {
  float x, y, z;
};

/// Points 0.1 m apart along the outline of an obstacle, at its middle's height: what a collision
/// monitor needs to see of it, a hole's too.
inline void add_outline(const scree::obstacle_t& obstacle, std::vector<Point>& points) {
  std::vector<std::pair<double, double>> corners;
  for (const auto& corner : obstacle.footprint) corners.emplace_back(corner[0], corner[1]);
  if (corners.empty()) {  // only the box is known
    const double c = std::cos(obstacle.yaw), s = std::sin(obstacle.yaw);
    for (const auto& [along, across] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
      const double x = along * obstacle.extent[0] / 2, y = across * obstacle.extent[1] / 2;
      corners.emplace_back(obstacle.center[0] + c * x - s * y, obstacle.center[1] + s * x + c * y);
    }
  }
  constexpr double kStep = 0.1;  // metres
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto [x, y] = corners[i];
    const auto [next_x, next_y] = corners[(i + 1) % corners.size()];
    const int steps = 1 + static_cast<int>(std::hypot(next_x - x, next_y - y) / kStep);
    for (int step = 0; step < steps; ++step) {
      const double share = static_cast<double>(step) / steps;
      points.push_back({static_cast<float>(x + share * (next_x - x)),
                        static_cast<float>(y + share * (next_y - y)),
                        static_cast<float>(obstacle.center[2])});
    }
  }
}

/// A sensor_msgs/PointCloud2 of the obstacles of one kind.
template <class Cloud>
void to_cloud(const scree::obstacle_list_t& list, std::int8_t kind, Cloud& cloud) {
  std::vector<Point> points;
  for (const scree::obstacle_t& obstacle : list.obstacles) {
    if (obstacle.kind == kind) add_outline(obstacle, points);
  }
  fill_header(list.stamp_ns, cloud.header);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.is_bigendian = false;
  cloud.is_dense = true;
  cloud.point_step = sizeof(Point);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.fields.clear();
  constexpr std::uint8_t kFloat32 = 7;  // PointField::FLOAT32
  for (const char* name : {"x", "y", "z"}) {
    const auto offset = static_cast<std::uint32_t>(cloud.fields.size() * sizeof(float));
    auto& field = cloud.fields.emplace_back();
    field.name = name;
    field.offset = offset;
    field.datatype = kFloat32;
    field.count = 1;
  }
  cloud.data.resize(cloud.row_step);
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.row_step);
}

}  // namespace scree_bridge
