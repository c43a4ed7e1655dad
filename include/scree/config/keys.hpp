#pragma once

#include <string>
#include <string_view>

#include "scree/config/settings.hpp"

namespace scree {

/// What a person needs to know of a key. The range is inclusive; {0, 0} where none applies.
struct Key {
  std::string_view table, name, unit;
  double low, high;
  std::string_view meaning;
};
/// As it is written in messages: table.key.
inline std::string full_name(const Key& key) {
  return std::string(key.table) + "." + std::string(key.name);
}

/// Calls visit(Key, value&) for every stage setting of one of the two sets.
template <class Detect, class Visit>
void for_each_detect_key(std::string_view table, Detect& detect, Visit&& visit) {
  const auto key = [&](std::string_view name, auto& value, std::string_view unit, double low,
                       double high, std::string_view meaning) {
    visit(Key{table, name, unit, low, high, meaning}, value);
  };
  key("max_points", detect.max_points, "points", 1, 1 << 26,
      "largest cloud; points beyond it are dropped and counted. Sets the memory taken at start");
  key("max_edge_points", detect.max_edge_points, "points", 1, 1 << 26,
      "most points steeper than edge_threshold; further ones are dropped and counted");
  key("max_obstacles", detect.max_obstacles, "obstacles", 1, 65536,
      "longest obstacle list; further ones are dropped and counted");
  key("voxel_grid", detect.voxel_grid, "", 0, 0,
      "thin the cloud to the centroid of each occupied voxel first");
  key("leaf_size", detect.leaf_size, "m", 0.001, 10,
      "edge of a voxel: larger is faster and smoother, smaller keeps small obstacles");
  key("clearance", detect.clearance, "m", 0, 100,
      "points higher than this above the lowest of their column are passed under and go (branches, "
      "ceilings); 0 keeps all");
  key("ground", detect.ground, "", 0, 0,
      "what heights are measured from: ring is the median of the points around each cluster, "
      "surface "
      "the ground that is spanned under rocks and over holes");
  key("max_ground_cells", detect.max_ground_cells, "cells", 64, 1 << 26,
      "largest raster of the ground's surface; a wider cloud gets larger cells. Sets the memory "
      "taken at start");
  key("ground_cell", detect.ground_cell, "m", 0.01, 10,
      "edge of its cells: smaller follows the ground closer and needs denser points");
  key("ground_points", detect.ground_points, "points", 1, 1000,
      "least mean number of points in the cells that have any; a sparser cloud gets larger cells");
  key("ground_slope", detect.ground_slope, "m/m", 0.01, 100,
      "steeper cells are no ground: lower finds flatter obstacles and more slopes of the ground");
  key("ground_tolerance", detect.ground_tolerance, "m", 0.001, 10,
      "a smooth patch this close to the continuation of the ground belongs to it");
  key("ground_trend", detect.ground_trend, "m", 0, 100,
      "the ground goes on as it runs on the whole within this distance, for clouds that have gaps; "
      "0: level. Larger spans wider gaps, smaller follows hills");
  key("candidates", detect.candidates, "", 0, 0,
      "what clusters are made of: edges are the steep points (paper), bodies all points above or "
      "below the ground's surface");
  key("body_height", detect.body_height, "m", 0, 10,
      "least height above or depth below the surface of a body's points");
  key("kernel_spacing", detect.kernel_spacing, "m", 0.001, 10,
      "d of the Sobel operator: distance of the eight positions around a point (paper fig. 3)");
  key("kernel_radius", detect.kernel_radius, "m", 0.001, 10,
      "r: reach of the kernel estimate at each position (eq. 4); not equal to kernel_spacing, or "
      "rounding decides which points lie inside");
  key("kernel_bandwidth", detect.kernel_bandwidth, "r", 0.05, 100,
      "standard deviation of the kernel in units of kernel_radius; the paper prints 2 (eq. 3)");
  key("kernel_neighbours", detect.kernel_neighbours, "points", 1, 1000,
      "least points at each of the eight positions for a gradient: more means fewer gradients on "
      "sparse ground, and better ones");
  key("kernel_shared", detect.kernel_shared, "m", 0, 1,
      "points nearer to one another in the plane share a gradient: faster where points stand above "
      "one another; 0: each has its own");
  key("edge_threshold", detect.edge_threshold, "m/m", 0, 100,
      "least slope of an edge point: lower finds flatter obstacles and more slopes of the ground");
  key("suppression", detect.suppression, "", 0, 0,
      "keep only points that are steepest along their gradient (paper fig. 4)");
  key("suppression_distance", detect.suppression_distance, "m", 0.001, 10,
      "distance of the two positions that a point is compared with");
  key("suppression_radius", detect.suppression_radius, "m", 0.001, 10,
      "reach of the mean at each of the two positions");
  key("cluster_method", detect.cluster_method, "", 0, 0,
      "supervoxel clusters the centres of super-voxels (algorithm 2), euclidean the edge points "
      "themselves (algorithm 1, the baseline), regions the bodies on the raster of the ground: "
      "seen "
      "ground parts them, unseen ground does not");
  key("saddle", detect.saddle, "", 0, 1,
      "two tops of a region are two bodies where the saddle between them is lower than this share "
      "of the lower top, heights weighed by the beams that end there; 0: never");
  key("voxel_size", detect.voxel_size, "m", 0.001, 10, "voxels that super-voxels are made of");
  key("seed_distance", detect.seed_distance, "m", 0.001, 10,
      "Rseed: grid of the super-voxels' seeds; the paper's 0.05 needs a far denser cloud");
  key("reflectivity_weight", detect.reflectivity_weight, "", 0, 1000,
      "wc of the metric D: how much a change of reflectivity parts super-voxels");
  key("spatial_weight", detect.spatial_weight, "", 0, 1000, "ws of the metric D: compactness");
  key("normal_weight", detect.normal_weight, "", 0, 1000,
      "wn of the metric D: how much a change of direction parts super-voxels");
  key("min_block_points", detect.min_block_points, "points", 1, 100000,
      "super-voxels with fewer points are noise and go; the paper has 6, on a denser cloud");
  key("cluster_tolerance", detect.cluster_tolerance, "m", 0.001, 10,
      "centres (or edge points) closer than this belong together: larger merges close obstacles, "
      "smaller splits rims");
  key("min_cluster_size", detect.min_cluster_size, "", 1, 100000,
      "least number of super-voxels (or of points, but with supervoxel) of an obstacle");
  key("ground_inner", detect.ground_inner, "m", 0, 10,
      "the ground's height is taken from this far around a cluster's box ...");
  key("ground_outer", detect.ground_outer, "m", 0.001, 20, "... to this far");
  key("network", detect.network, "", 0, 0, "file of the trained network's weights");
  key("min_confidence", detect.min_confidence, "", 0, 1,
      "least answer of the network for an obstacle: higher means fewer ghosts and more misses");
}

/// Calls visit(Key, value&) for every configuration key there is: the one table of them.
template <class AnySettings, class Visit>
void for_each_key(AnySettings& settings, Visit&& visit) {
  std::string_view table;
  const auto key = [&](std::string_view name, auto& value, std::string_view unit, double low,
                       double high, std::string_view meaning) {
    visit(Key{table, name, unit, low, high, meaning}, value);
  };

  table = "lidar";
  auto& lidar = settings.lidar;
  key("model", lidar.model, "", 0, 0, "which table of vertical angles the sensor has");
  key("address", lidar.address, "", 0, 0, "local address to listen on; 0.0.0.0 is every interface");
  key("port", lidar.port, "", 1, 65535, "UDP port of the data packets");
  key("position_port", lidar.position_port, "", 1, 65535, "UDP port of the position packets");
  key("sender", lidar.sender, "", 0, 0, "accept packets from this address only; empty accepts any");
  key("translation", lidar.translation, "m", -100, 100, "lidar origin in base: x, y, z");
  key("rpy_deg", lidar.rpy_deg, "deg", -360, 360,
      "rotation lidar -> base: roll, pitch, yaw, applied as Rz(yaw) Ry(pitch) Rx(roll)");
  key("min_range", lidar.min_range, "m", 0, 200, "returns closer than this are the robot itself");
  key("max_range", lidar.max_range, "m", 0.1, 200, "returns beyond this are not used");
  key("cut_azimuth_deg", lidar.cut_azimuth_deg, "deg", 0, 359.99,
      "azimuth at which a sweep ends and the next begins");

  table = "imu";
  auto& imu = settings.imu;
  key("device", imu.device, "", 0, 0, "serial port of the Xsens MTi");
  key("baud", imu.baud, "bit/s", 4800, 4000000, "its bit rate");
  key("configure", imu.configure, "", 0, 0,
      "set up its bit rate and its outputs at start; with false it is taken as it is and nothing "
      "is "
      "sent to it");
  key("rate", imu.rate, "Hz", 100, 400,
      "orientations, accelerations and rates a second: more follows fast motion better and needs a "
      "faster line");
  key("acceleration_hr_rate", imu.acceleration_hr_rate, "Hz", 0, 1000,
      "accelerations a second besides, at high rate, for recordings; 0 for none");
  key("gyro_hr_rate", imu.gyro_hr_rate, "Hz", 0, 1000,
      "rates of turn a second besides, at high rate, for recordings; 0 for none");
  key("rpy_deg", imu.rpy_deg, "deg", -360, 360, "rotation imu -> base: roll, pitch, yaw");
  key("translation", imu.translation, "m", -100, 100, "imu origin in base: x, y, z");

  table = "encoder";
  auto& encoder = settings.encoder;
  key("interface", encoder.interface, "", 0, 0, "SocketCAN interface of the wheel encoder");
  key("dbc", encoder.dbc, "", 0, 0,
      "DBC file that says where the signal lies, beside this file; empty: the keys can_id to "
      "signed "
      "say it");
  key("signal", encoder.signal, "", 0, 0, "its signal there: MESSAGE.SIGNAL");
  key("can_id", encoder.can_id, "", 0, 0x1FFFFFFF,
      "identifier of its frame; above 0x7FF: an extended (29-bit) one");
  key("start_bit", encoder.start_bit, "", 0, 511,
      "DBC numbering: for big_endian the most significant bit's position");
  key("length", encoder.length, "bit", 1, 64, "length of the signal");
  key("byte_order", encoder.byte_order, "", 0, 0, "of the signal");
  key("signed", encoder.is_signed, "", 0, 0, "whether the signal is two's complement");
  key("kind", encoder.kind, "", 0, 0,
      "counter wraps at its length; speed is metres per second after scaling");
  key("scale", encoder.scale, "m or m/s", -1e6, 1e6,
      "metres per count, or m/s per unit; with a DBC file per unit of its physical value: 0.277778 "
      "for km/h; below zero where the wheel counts backwards");
  key("max_speed", encoder.max_speed, "m/s", 0.1, 200,
      "readings that ask for a faster wheel are refused, and counted");
  key("max_acceleration", encoder.max_acceleration, "m/s^2", 0.1, 1000,
      "the same for a wheel that gains or loses speed faster; it spins up and is blocked faster "
      "than "
      "the robot, so leave room");

  table = "gpio";
  auto& gpio = settings.gpio;
  key("pps", gpio.pps, "", 0, 0,
      "line on which a GPS receiver's pulse per second arrives, CHIP:LINE as gpiochip0:18, the "
      "line "
      "by number or name; empty: none");
  key("pps_active_low", gpio.pps_active_low, "", 0, 0, "the second begins where its level falls");
  key("stop", gpio.stop, "", 0, 0,
      "line that is on while the robot is blind or an obstacle is in the stop zone; empty: none");
  key("stop_active_low", gpio.stop_active_low, "", 0, 0,
      "on is the low level: with a pull-down, a broken cable stops the robot too");
  key("heartbeat", gpio.heartbeat, "", 0, 0,
      "line that changes with every obstacle list, for a watchdog; empty: none");
  key("heartbeat_active_low", gpio.heartbeat_active_low, "", 0, 0, "it begins at the high level");

  table = "stop";
  auto& stop = settings.stop;
  key("length", stop.length, "m", 0.1, 50,
      "the stop zone reaches this far ahead of the origin of base: braking distance and the way of "
      "0.3 s");
  key("width", stop.width, "m", 0.1, 50, "of the stop zone: the robot's, and room on both sides");
  key("hold", stop.hold, "s", 0, 60, "the line stays on this long after the reason has gone");

  table = "map";
  auto& map = settings.map;
  key("wait", map.wait, "s", 0, 1,
      "a sweep waits this long for the IMU and encoder samples that cover it: longer bears a "
      "busier "
      "host, and delays lists while a sensor is slow");
  key("registration", map.registration, "", 0, 0,
      "correct the pose by laying each sweep onto the ground seen before; false: dead reckoning "
      "alone");
  key("registration_reach", map.registration_reach, "m", 1, 18,
      "points this far from the robot take part in registration");
  key("voxel", map.voxel, "m", 0.01, 1, "edge of the map's voxels: larger is faster and coarser");
  key("reach", map.reach, "m", 2, 100,
      "the map reaches this far around the robot; what lies beyond is forgotten");
  key("search_reach", map.search_reach, "m", 2, 15,
      "obstacles are searched for in the map this far around the robot; farther off it only "
      "gathers what will be needed");
  key("keep_seconds", map.keep_seconds, "s", 1, 86400,
      "what was not seen for so long is forgotten: longer keeps more behind corners, and more of "
      "the "
      "pose's drift");
  key("max_points", map.max_points, "points", 1, 1 << 20,
      "longest sweep; points beyond it are dropped and counted. Sets the memory taken at start");
  key("max_voxels", map.max_voxels, "voxels", 1024, 1 << 24,
      "largest map; points without a voxel are dropped and counted. Sets the memory taken at "
      "start");

  for_each_detect_key("detect.cloud", settings.detect_cloud, visit);
  for_each_detect_key("detect.map", settings.detect_map, visit);
  for_each_detect_key("detect.sweep", settings.detect_sweep, visit);

  table = "track";
  auto& track = settings.track;
  key("network", track.network, "", 0, 0,
      "file of the weights of the network that judges what is followed; empty: its confidence, "
      "smoothed, decides (then 0.7 and 0.45 suit below)");
  key("smoothing", track.smoothing, "", 0.01, 1,
      "share of the newest answer in an obstacle's confidence: lower flickers less and answers "
      "later");
  key("appear", track.appear, "", 0, 1, "an obstacle is published from this confidence on");
  key("disappear", track.disappear, "", 0, 1, "... and until it falls below this");
  key("remember", track.remember, "s", 0, 60,
      "an obstacle that is not found any more stays this long, unless its place was seen empty");
  key("reach", track.reach, "m", 1, 100,
      "an obstacle is published when a part of it lies within this distance of the robot: farther "
      "off the lidar's rings lie too far apart to tell it from a slope, so there it is followed "
      "only");

  table = "lcm";
  key("url", settings.lcm.url, "", 0, 0,
      "LCM provider; ttl=0 stays on this computer, ttl=1 reaches the local network");
}

}  // namespace scree
