// The bridge's conversion with stand-ins for the types of ROS 2, which have the same members.
#include "examples/ros2/conversion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace {

struct Time {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
};
struct Header {
  Time stamp;
  std::string frame_id;
};
struct Vector {
  double x = 0, y = 0, z = 0;
};
struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
};
struct RosPose {
  Vector position;
  Quaternion orientation;
};
struct Hypothesis {
  std::string class_id;
  double score = 0;
};
struct PoseWithCovariance {
  RosPose pose;
};
struct Result {
  Hypothesis hypothesis;
  PoseWithCovariance pose;
};
struct Box {
  RosPose center;
  Vector size;
};
struct Detection {
  Header header;
  std::vector<Result> results;
  Box bbox;
  std::string id;
};
struct Detections {
  Header header;
  std::vector<Detection> detections;
};
struct Grid {
  struct {
    Time map_load_time;
    float resolution = 0;
    std::uint32_t width = 0, height = 0;
    RosPose origin;
  } info;
  Header header;
  std::vector<std::int8_t> data;
};
struct Field {
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 0;
};
struct Cloud {
  Header header;
  std::uint32_t height = 0, width = 0, point_step = 0, row_step = 0;
  std::vector<Field> fields;
  bool is_bigendian = true, is_dense = false;
  std::vector<std::uint8_t> data;
};
struct Transform {
  Header header;
  std::string child_frame_id;
  struct {
    Vector translation;
    Quaternion rotation;
  } transform;
};

scree::obstacle_t obstacle(std::int8_t kind, std::vector<std::vector<double>> footprint) {
  scree::obstacle_t it{};
  it.id = 7;
  it.kind = kind;
  it.confidence = 0.75F;
  it.center[0] = 4, it.center[1] = 1, it.center[2] = 0.25;
  it.extent[0] = 2, it.extent[1] = 1, it.extent[2] = 0.5;
  it.yaw = std::acos(-1.0) / 2;
  it.footprint = std::move(footprint);
  it.corners = static_cast<std::int32_t>(it.footprint.size());
  return it;
}

scree::obstacle_list_t rock_and_hole() {
  scree::obstacle_list_t list{};
  list.stamp_ns = 1'598'601'600'123'456'789;
  list.p[0] = 1, list.p[2] = 0.5;
  list.q[0] = 0.5, list.q[3] = 0.75;
  list.obstacles = {obstacle(scree::obstacle_t::POSITIVE, {}),
                    obstacle(scree::obstacle_t::NEGATIVE, {{0, 0}, {1, 0}, {0, 1}})};
  list.size = 2;
  return list;
}

std::vector<scree_bridge::Point> points_of(const Cloud& cloud) {
  std::vector<scree_bridge::Point> points(cloud.width);
  std::memcpy(points.data(), cloud.data.data(), cloud.data.size());
  return points;
}

TEST(Ros2Conversion, ABoxAndAHypothesisForEachObstacle) {
  Detections ros;
  scree_bridge::to_detections(rock_and_hole(), ros);
  EXPECT_EQ(ros.header.stamp.sec, 1'598'601'600);
  EXPECT_EQ(ros.header.stamp.nanosec, 123'456'789U);
  EXPECT_EQ(ros.header.frame_id, "odom");
  ASSERT_EQ(ros.detections.size(), 2U);
  const Detection& rock = ros.detections[0];
  EXPECT_EQ(rock.id, "7");
  EXPECT_EQ(rock.bbox.center.position.x, 4);
  EXPECT_EQ(rock.bbox.size.x, 2);
  EXPECT_NEAR(rock.bbox.center.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(rock.bbox.center.orientation.w, std::sqrt(0.5), 1e-12);
  ASSERT_EQ(rock.results.size(), 1U);
  EXPECT_EQ(rock.results[0].hypothesis.class_id, "positive");
  EXPECT_EQ(rock.results[0].hypothesis.score, 0.75);
  EXPECT_EQ(rock.results[0].pose.pose.position.z, 0.25);
  EXPECT_EQ(ros.detections[1].results[0].hypothesis.class_id, "negative");
}

TEST(Ros2Conversion, TheGridIsFreeOccupiedOrUnknown) {
  scree::grid_t grid{};
  grid.columns = 2, grid.rows = 2, grid.cells = 4;
  grid.cell_size = 0.2;
  grid.origin[0] = -3, grid.origin[1] = 5, grid.p[2] = 0.5;
  grid.state = {grid.UNKNOWN, grid.FREE, grid.OCCUPIED, grid.DROP};
  Grid ros;
  scree_bridge::to_occupancy(grid, ros);
  EXPECT_EQ(ros.data, (std::vector<std::int8_t>{-1, 0, 100, 100}));
  EXPECT_EQ(ros.info.width, 2U);
  EXPECT_FLOAT_EQ(ros.info.resolution, 0.2F);
  EXPECT_EQ(ros.info.origin.position.x, -3);
  EXPECT_EQ(ros.info.origin.position.y, 5);
  EXPECT_EQ(ros.info.origin.position.z, 0.5);
}

TEST(Ros2Conversion, RocksAndHolesAreOutlinesInCloudsOfTheirOwn) {
  Cloud rocks, holes;
  scree_bridge::to_cloud(rock_and_hole(), scree::obstacle_t::POSITIVE, rocks);
  scree_bridge::to_cloud(rock_and_hole(), scree::obstacle_t::NEGATIVE, holes);
  ASSERT_EQ(rocks.fields.size(), 3U);
  EXPECT_EQ(rocks.fields[2].name, "z");
  EXPECT_EQ(rocks.fields[2].offset, 8U);
  EXPECT_EQ(rocks.fields[2].datatype, 7);
  EXPECT_EQ(rocks.data.size(), rocks.width * 12U);
  EXPECT_GE(rocks.width, 60U) << "a box of 2 m by 1 m, a point every 0.1 m";
  for (const auto& point : points_of(rocks)) {
    EXPECT_LE(std::abs(point.x - 4), 0.501) << "its length lies along y";
    EXPECT_LE(std::abs(point.y - 1), 1.001);
    EXPECT_FLOAT_EQ(point.z, 0.25F);
  }
  EXPECT_GE(holes.width, 34U);
  for (const auto& point : points_of(holes)) EXPECT_LE(point.x + point.y, 1.001);
  scree_bridge::to_cloud(scree::obstacle_list_t{}, scree::obstacle_t::POSITIVE, rocks);
  EXPECT_EQ(rocks.width, 0U);
  EXPECT_TRUE(rocks.data.empty());
}

TEST(Ros2Conversion, ThePoseIsTheTransformOfBase) {
  Transform ros;
  scree_bridge::to_transform(rock_and_hole(), ros);
  EXPECT_EQ(ros.header.frame_id, "odom");
  EXPECT_EQ(ros.child_frame_id, "base_link");
  EXPECT_EQ(ros.transform.translation.x, 1);
  EXPECT_EQ(ros.transform.rotation.w, 0.5);
  EXPECT_EQ(ros.transform.rotation.z, 0.75);
}

}  // namespace
