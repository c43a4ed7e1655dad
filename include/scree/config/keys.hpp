#pragma once

#include <array>
#include <string_view>

#include "scree/config/detect_keys.hpp"

namespace scree {

/// Calls visit(Key, value&) for every configuration key there is, live or not: the one table of
/// them.
template <class AnySettings, class Visit>
void for_every_key(AnySettings& settings, Visit&& visit) {
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
  key("device", imu.device, "", 0, 0, "serial port of the Xsens MTi; empty: there is none");
  key("baud", imu.baud, "bit/s", 4800, 4000000, "its bit rate");
  key("configure", imu.configure, "", 0, 0,
      "set up its bit rate and its outputs at start; with false it is taken as it is and nothing "
      "is sent to it");
  key("rate", imu.rate, "Hz", 100, 400,
      "orientations, accelerations and rates a second: more follows fast motion better and needs a "
      "faster line");
  key("acceleration_hr_rate", imu.acceleration_hr_rate, "Hz", 0, 1000,
      "accelerations a second besides, at high rate, for recordings; 0 for none");
  key("gyro_hr_rate", imu.gyro_hr_rate, "Hz", 0, 1000,
      "rates of turn a second besides, at high rate, for recordings; 0 for none");
  key("rpy_deg", imu.rpy_deg, "deg", -360, 360, "rotation imu -> base: roll, pitch, yaw");
  key("translation", imu.translation, "m", -100, 100, "imu origin in base: x, y, z");
  key("delay", imu.delay, "s", -kMostDelay, kMostDelay,
      "its messages take so much longer to the host than the lidar's: `scree calibrate` finds it");

  table = "encoder";
  auto& encoder = settings.encoder;
  key("interface", encoder.interface, "", 0, 0,
      "SocketCAN interface of the wheel encoder; empty: there is none");
  key("dbc", encoder.dbc, "", 0, 0,
      "DBC file that says where the signal lies, beside this file; empty: the keys can_id to "
      "signed say it");
  key("signal", encoder.signal, "", 0, 0, "its signal there: MESSAGE.SIGNAL");
  key("can_id", encoder.can_id, "", 0, 0x1FFFFFFF,
      "identifier of its frame; above 0x7FF: an extended (29-bit) one");
  key("extended", encoder.is_extended, "", 0, 0,
      "whether the identifier is an extended one although it is not above 0x7FF");
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
  key("translation", encoder.translation, "m", -100, 100,
      "where the wheel touches the ground, in base: x, y, z; a wheel beside the middle rolls "
      "farther on the outer side of a turn");
  key("delay", encoder.delay, "s", -kMostDelay, kMostDelay, "as imu.delay");
  key("max_speed", encoder.max_speed, "m/s", 0.1, 200,
      "readings that ask for a faster wheel are refused, and counted");
  key("max_acceleration", encoder.max_acceleration, "m/s^2", 0.1, 1000,
      "the same for a wheel that gains or loses speed faster; it spins up and is blocked faster "
      "than the robot, so leave room");

  table = "robot";
  key("body", settings.robot.body, "m", -100, 100,
      "boxes of the robot's own body in base, [[[x, y, z], [x, y, z]], ...], each by two opposite "
      "corners: returns from within are used for nothing");

  table = "gpio";
  auto& gpio = settings.gpio;
  key("pps", gpio.pps, "", 0, 0,
      "line on which a GPS receiver's pulse per second arrives, CHIP:LINE as gpiochip0:18, the "
      "line by number or name; empty: none");
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
      "busier host, and delays lists while a sensor is slow");
  key("registration", map.registration, "", 0, 0,
      "correct the pose by laying each sweep onto the ground seen before; false: dead reckoning "
      "alone, and without IMU and encoder each sweep by itself");
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
      "the pose's drift");

  table = "detect";
  key("lists_per_turn", settings.detect.lists_per_turn, "", 1, 8,
      "1, 2, 4 or 8: a list after each such part of a turn, so that what it shows is known sooner; "
      "each list costs as much as one after a whole turn");

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
  key("least_height", track.least_height, "m", 0, 1,
      "what is lower, or a shallower hole, is not published: wheels pass it. Half of this suffices "
      "for what is as long as a kerb, and for a hole whose floor is not seen: both may be more "
      "than they look");

  table = "lcm";
  key("url", settings.lcm.url, "", 0, 0,
      "LCM provider; ttl=0 stays on this computer, ttl=1 reaches the local network");
  key("grid", settings.lcm.grid, "", 0, 0,
      "publish after each list from the map what is free, occupied, a drop or unknown around the "
      "robot, on SCREE_GRID; only with detect.map.method = \"surface\"");
  key("grid_cell", settings.lcm.grid_cell, "m", 0.1, 1,
      "edge of its cells: smaller shows narrower gaps; it has 128 x 128 at most, so smaller ones "
      "than map.search_reach / 64 reach less far");

  table = "blackbox";
  auto& blackbox = settings.blackbox;
  key("folder", blackbox.folder, "", 0, 0,
      "keep lists, grids and health of the latest past here, in files that are bounded, and close "
      "them when something happens; /var/lib/scree/blackbox for the service; empty: nothing is "
      "kept");
  key("seconds", blackbox.seconds, "s", 6, 3600, "how much of the past is kept");
  key("megabytes", blackbox.megabytes, "MB", 6, 100000, "... and how much of the disk at most");
  key("keep", blackbox.keep, "", 1, 10000, "closed files that stay; older ones are removed");
  key("packets", blackbox.packets, "", 0, 0,
      "keep the lidar's packets too, 1 MB a second, so that what happened can be computed again");

  table = "metrics";
  key("file", settings.metrics.file, "", 0, 0,
      "write health here once a second for the textfile collector of Prometheus' node_exporter, as "
      "/var/lib/prometheus/node-exporter/scree.prom; empty: none");

  table = "memory";
  auto& memory = settings.memory;
  key("sweep_points", memory.sweep_points, "points", 2, 1 << 20,
      "longest sweep; points beyond it are dropped and counted");
  key("map_voxels", memory.map_voxels, "voxels", 1024, 1 << 24,
      "largest map; points without a voxel are dropped and counted");
  key("cloud_points", memory.cloud_points, "points", 4, 1 << 26,
      "a longer cloud of `scree detect` takes the memory that it needs");
  key("ground_cells", memory.ground_cells, "cells", 64, 1 << 26,
      "largest raster of the ground's surface, a fourth of a cloud's; wider ground gets larger "
      "cells");
  key("obstacles", memory.obstacles, "obstacles", 1, 65536,
      "longest obstacle list; further ones are dropped and counted");
}

/// The same for the keys that are read as things are set.
template <class AnySettings, class Visit>
void for_each_key(AnySettings& settings, Visit&& visit) {
  for_every_key(settings, [&](const Key& key, auto& value) {
    if (key.is_live) visit(key, value);
  });
}

/// The shipped file in which a key stands: scree.toml for what a robot's owner sets, else the
/// profile of the part that it tunes.
std::string_view file_of(const Key& key);
inline constexpr std::string_view kOwnersFile = "scree.toml";
/// In the order in which they are read.
inline constexpr std::array<std::string_view, 3> kProfiles = {"cloud.toml", "map.toml",
                                                              "sweep.toml"};

}  // namespace scree
