// Publishes what screed publishes as ROS 2 messages. Nothing is published while screed is blind or
// silent: a collision monitor then stops the robot by its source_timeout.
#include <tf2_ros/transform_broadcaster.h>

#include <geometry_msgs/msg/transform_stamped.hpp>
#include <lcm/lcm-cpp.hpp>
#include <nav_msgs/msg/occupancy_grid.hpp>
#include <rclcpp/rclcpp.hpp>
#include <scree/health_t.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_msgs/msg/bool.hpp>
#include <vision_msgs/msg/detection3_d_array.hpp>

#include "conversion.hpp"

namespace {

using nav_msgs::msg::OccupancyGrid;
using sensor_msgs::msg::PointCloud2;
using std_msgs::msg::Bool;
using vision_msgs::msg::Detection3DArray;

class Bridge : public rclcpp::Node {
public:
  Bridge()
      : Node("scree_bridge"),
        lcm_(declare_parameter("lcm_url", "udpm://239.255.76.67:7667?ttl=0")),
        detections_(create_publisher<Detection3DArray>("scree/detections", 10)),
        obstacles_(create_publisher<PointCloud2>("scree/obstacles", rclcpp::SensorDataQoS())),
        voids_(create_publisher<PointCloud2>("scree/voids", rclcpp::SensorDataQoS())),
        grid_(create_publisher<OccupancyGrid>("scree/grid", 10)),
        stop_(create_publisher<Bool>("scree/stop", 10)),
        frames_(*this) {
    lcm_.subscribe("SCREE_OBSTACLES", &Bridge::take_list, this);
    lcm_.subscribe("SCREE_GRID", &Bridge::take_grid, this);
    lcm_.subscribe("SCREE_HEALTH", &Bridge::take_health, this);
  }

  /// Waits for a message for a moment. False when LCM failed.
  bool handle() {
    constexpr int kPauseMs = 100;
    return lcm_.handleTimeout(kPauseMs) >= 0;
  }

private:
  using Buffer = lcm::ReceiveBuffer;

  void take_list(const Buffer*, const std::string&, const scree::obstacle_list_t* list) {
    geometry_msgs::msg::TransformStamped base;
    scree_bridge::to_transform(*list, base);
    frames_.sendTransform(base);
    Detection3DArray detections;
    scree_bridge::to_detections(*list, detections);
    detections_->publish(detections);
    PointCloud2 cloud;
    scree_bridge::to_cloud(*list, scree::obstacle_t::POSITIVE, cloud);
    obstacles_->publish(cloud);
    scree_bridge::to_cloud(*list, scree::obstacle_t::NEGATIVE, cloud);
    voids_->publish(cloud);
  }
  void take_grid(const Buffer*, const std::string&, const scree::grid_t* grid) {
    OccupancyGrid occupancy;
    scree_bridge::to_occupancy(*grid, occupancy);
    grid_->publish(occupancy);
  }
  void take_health(const Buffer*, const std::string&, const scree::health_t* health) {
    Bool stop;
    stop.data = health->state != scree::health_t::OK || health->stop != 0;
    stop_->publish(stop);
  }

  lcm::LCM lcm_;
  rclcpp::Publisher<Detection3DArray>::SharedPtr detections_;
  rclcpp::Publisher<PointCloud2>::SharedPtr obstacles_, voids_;
  rclcpp::Publisher<OccupancyGrid>::SharedPtr grid_;
  rclcpp::Publisher<Bool>::SharedPtr stop_;
  tf2_ros::TransformBroadcaster frames_;
};

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  const auto bridge = std::make_shared<Bridge>();
  while (rclcpp::ok() && bridge->handle()) rclcpp::spin_some(bridge);
  rclcpp::shutdown();
}
