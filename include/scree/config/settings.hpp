#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scree/core/pose.hpp"
#include "scree/core/result.hpp"

namespace scree {

enum class LidarModel : std::uint8_t { vlp16, puck_lite, puck_hires };
enum class ByteOrder : std::uint8_t { little_endian, big_endian };
enum class EncoderKind : std::uint8_t { counter, speed };
/// How obstacles are looked for: edges is the paper's method, clusters of steep points; surface is
/// ours, clusters of what stands above the ground's surface or lies below it.
enum class Method : std::uint8_t { edges, surface };
enum class EdgeClustering : std::uint8_t { supervoxel, euclidean };
enum class SurfaceClustering : std::uint8_t { regions, euclidean };

/// The words for an enum in a configuration file.
template <class Enum>
constexpr std::array<std::pair<std::string_view, Enum>, 0> kNames{};
template <>
inline constexpr std::array kNames<LidarModel> = {
    std::pair{std::string_view("vlp16"), LidarModel::vlp16},
    std::pair{std::string_view("puck_lite"), LidarModel::puck_lite},
    std::pair{std::string_view("puck_hires"), LidarModel::puck_hires}};
template <>
inline constexpr std::array kNames<ByteOrder> = {
    std::pair{std::string_view("little_endian"), ByteOrder::little_endian},
    std::pair{std::string_view("big_endian"), ByteOrder::big_endian}};
template <>
inline constexpr std::array kNames<EncoderKind> = {
    std::pair{std::string_view("counter"), EncoderKind::counter},
    std::pair{std::string_view("speed"), EncoderKind::speed}};
template <>
inline constexpr std::array kNames<Method> = {
    std::pair{std::string_view("edges"), Method::edges},
    std::pair{std::string_view("surface"), Method::surface}};
template <>
inline constexpr std::array kNames<EdgeClustering> = {
    std::pair{std::string_view("supervoxel"), EdgeClustering::supervoxel},
    std::pair{std::string_view("euclidean"), EdgeClustering::euclidean}};
template <>
inline constexpr std::array kNames<SurfaceClustering> = {
    std::pair{std::string_view("regions"), SurfaceClustering::regions},
    std::pair{std::string_view("euclidean"), SurfaceClustering::euclidean}};

template <class Enum>
constexpr std::string_view name_of(Enum value) {
  for (const auto& [name, candidate] : kNames<Enum>) {
    if (candidate == value) return name;
  }
  return "?";
}

// What each value means, its unit and its range stand in config/keys.hpp, the one table of them.

struct LidarSettings {
  LidarModel model = LidarModel::vlp16;
  std::string address = "0.0.0.0";
  int port = 2368;
  int position_port = 8308;
  std::string sender;
  Eigen::Vector3d translation{0, 0, 0};
  Eigen::Vector3d rpy_deg{0, 0, 0};
  double min_range = 0.5;
  double max_range = 30.0;
  double cut_azimuth_deg = 0.0;

  /// `lidar` in `base`.
  Pose mount() const {
    return {translation,
            from_roll_pitch_yaw(radians(rpy_deg.x()), radians(rpy_deg.y()), radians(rpy_deg.z()))};
  }
};

/// Seconds that a sensor's messages may take longer to the host than the lidar's.
inline constexpr double kMostDelay = 0.1;

struct ImuSettings {
  std::string device = "/dev/ttyUSB0";
  int baud = 921600;
  bool configure = true;
  int rate = 100;
  int acceleration_hr_rate = 0;
  int gyro_hr_rate = 0;
  Eigen::Vector3d rpy_deg{0, 0, 0};
  Eigen::Vector3d translation{0, 0, 0};
  double delay = 0;

  /// `imu` in `base`.
  Pose mount() const {
    return {translation,
            from_roll_pitch_yaw(radians(rpy_deg.x()), radians(rpy_deg.y()), radians(rpy_deg.z()))};
  }
};

/// Where a signal lies in the data of a frame, by the rules of DBC files.
struct SignalPlace {
  int start_bit = 0, length = 32;
  ByteOrder byte_order = ByteOrder::little_endian;

  /// Bytes that a frame must have to hold the signal.
  int frame_bytes() const {
    if (byte_order == ByteOrder::little_endian) return (start_bit + length + 7) / 8;
    // In the first byte the signal has the bits from its start downwards, then whole bytes follow.
    return start_bit / 8 + 1 + std::max(length - start_bit % 8 - 1 + 7, 0) / 8;
  }
};

struct EncoderSettings : SignalPlace {
  std::string interface = "can0";
  std::string dbc, signal;
  std::int64_t can_id = 0x1A0;
  bool is_signed = true;
  EncoderKind kind = EncoderKind::counter;
  double scale = 0.000157;
  Eigen::Vector3d translation{0, 0, 0};
  double delay = 0;
  double max_speed = 5.0;
  double max_acceleration = 10.0;

  bool is_extended = false;  ///< 29 bits although can_id is not above 0x7FF

  // No keys: what only a DBC file says, filled in by encoder::with_dbc().
  double factor = 1, offset = 0;  ///< scale multiplies raw * factor + offset
  bool is_float = false;          ///< raw holds the bits of a float (length 32) or a double (64)
  bool any_source = false;        ///< J1939: can_id stands for its parameter group from any source
  /// What raw * factor + offset can be; without end where nothing is known.
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> unavailable;  ///< raw values that stand for "not available", "error"
  /// An unsigned signal that must have a value for a frame to hold the encoder's.
  struct Selector : SignalPlace {
    std::int64_t value = 0;
  };
  std::optional<Selector> selector;

  bool has_extended_id() const { return is_extended || can_id > 0x7FF; }
  /// The bits of an identifier that must agree with can_id: from any source those of the parameter
  /// group (SAE J1939-21: neither the priority nor the source).
  std::uint32_t id_mask() const { return any_source ? 0x03FFFF00U : 0x1FFFFFFFU; }
};

/// A box of the robot's body in `base`, metres.
struct BodyBox {
  Eigen::Vector3d low, high;  ///< two opposite corners, low below high in each coordinate

  bool operator==(const BodyBox&) const = default;
  bool contains(const Eigen::Vector3d& place) const {
    return (place.array() >= low.array()).all() && (place.array() <= high.array()).all();
  }
};

struct RobotSettings {
  std::vector<BodyBox> body;
};

struct GpioSettings {
  std::string pps, stop, heartbeat;
  bool pps_active_low = false, stop_active_low = false, heartbeat_active_low = false;
};

struct StopSettings {
  double length = 2.0;
  double width = 1.0;
  double hold = 0.5;
};

/// The ground put together of many sweeps while driving.
struct MapSettings {
  double wait = 0.05;
  bool registration = true;
  double registration_reach = 15;
  double voxel = 0.05;
  double reach = 18;
  double search_reach = 12;
  double keep_seconds = 60;
};

/// Obstacles followed from list to list.
struct TrackingSettings {
  /// What is found in a list is published at once, unless it is below the default least_height, and
  /// gone when the next one has it no more: only its id stays as long.
  static TrackingSettings for_sweep();

  std::string network = "network_track.txt";
  std::uint32_t least_found = 2;  ///< lists that have a published obstacle
  double smoothing = 0.4;
  double appear = 0.35;
  double disappear = 0.26;
  double remember = 1.0;
  double reach = 10;
  double least_height = 0.12;  ///< metres; also the least depth of a hole
};

/// Gaussian-kernel Sobel operator (paper eq. 1-4).
struct KernelSettings {
  double spacing = 0.10;
  double radius = 0.11;
  double bandwidth = 2.0;
  int neighbours = 1;
};

/// The paper's method; the defaults are its own, on clouds as dense as the paper's.
struct EdgeSettings {
  KernelSettings kernel;
  double threshold = 0.35;

  bool suppression = true;
  double suppression_distance = 0.10;
  double suppression_radius = 0.11;

  EdgeClustering clustering = EdgeClustering::supervoxel;
  double voxel_size = 0.08;
  double seed_distance = 0.25;
  double reflectivity_weight = 0.1;
  double spatial_weight = 0.4;
  double normal_weight = 1.0;
  int min_block_points = 4;
  double cluster_tolerance = 0.40;
  int min_cluster_size = 3;

  double ground_inner = 0.15;
  double ground_outer = 0.60;
};

/// Our method; the defaults are for reconstructed clouds.
struct SurfaceSettings {
  double ground_cell = 0.08;
  double ground_points = 2.15;
  double ground_slope = 0.34;
  double ground_tolerance = 0.10;
  double ground_trend = 0;

  double body_height = 0.06;
  KernelSettings kernel;

  SurfaceClustering clustering = SurfaceClustering::euclidean;
  double saddle = 0.6;
  double cluster_tolerance = 0.20;
  int min_cluster_size = 4;
};

/// There is one set for reconstructed clouds, one for the map that grows while driving, and one for
/// single sweeps, because every length follows the density of the points. Of the two methods'
/// settings only those of `method` count.
struct DetectSettings {
  Method method = Method::surface;
  double leaf_size = 0.0592;
  double clearance = 2.0;
  EdgeSettings edges;
  SurfaceSettings surface;
  std::string network;
  double min_confidence = 0.5;

  /// The method as the paper has it, for clouds.
  static DetectSettings for_paper();
  static DetectSettings for_cloud();
  static DetectSettings for_map();
  static DetectSettings for_sweep();
};

/// What both methods share while driving.
struct ListSettings {
  int lists_per_turn = 1;
};

/// How much a detector has room for.
struct DetectorLimits {
  std::size_t points = 0;        ///< of a cloud
  std::size_t candidates = 0;    ///< points that clusters are made of
  std::size_t ground_cells = 0;  ///< of the ground's raster
  std::size_t obstacles = 0;     ///< of a list
};

/// What the memory is taken for at the start.
struct MemorySettings {
  int sweep_points = 1 << 17;
  int map_voxels = 1 << 19;
  int cloud_points = 1 << 20;
  int ground_cells = 1 << 17;
  int obstacles = 512;

  /// A quarter of a cloud's points leaves room: a fifth were edges in the paper's. A sweep has less
  /// ground between what stands on it. A cloud's ground is wider than that around a robot.
  DetectorLimits for_cloud() const {
    DetectorLimits cloud = limits(cloud_points, 4);
    cloud.ground_cells *= 4;
    return cloud;
  }
  DetectorLimits for_map() const { return limits(map_voxels, 4); }
  DetectorLimits for_sweep() const { return limits(sweep_points, 2); }

private:
  DetectorLimits limits(int points, int candidate_share) const {
    return {static_cast<std::size_t>(points), static_cast<std::size_t>(points / candidate_share),
            static_cast<std::size_t>(ground_cells), static_cast<std::size_t>(obstacles)};
  }
};

struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
  bool grid = true;
  double grid_cell = 0.2;
};

/// What screed keeps of the latest past, in files.
struct BlackBoxSettings {
  std::string folder;  ///< empty: none
  double seconds = 60;
  int megabytes = 100;
  int keep = 20;
  bool packets = false;
};

struct MetricsSettings {
  std::string file;  ///< empty: none
};

struct Settings {
  LidarSettings lidar;
  ImuSettings imu;
  EncoderSettings encoder;
  RobotSettings robot;
  GpioSettings gpio;
  StopSettings stop;
  ListSettings detect;
  DetectSettings detect_cloud = DetectSettings::for_cloud();
  DetectSettings detect_map = DetectSettings::for_map();
  DetectSettings detect_sweep = DetectSettings::for_sweep();
  MapSettings map;
  TrackingSettings track;
  LcmSettings lcm;
  BlackBoxSettings blackbox;
  MetricsSettings metrics;
  MemorySettings memory;

  /// How long a sweep waits for the samples that cover it, seconds: `map.wait`, and what they take
  /// longer than the lidar's.
  double motion_wait() const { return map.wait + std::max({imu.delay, encoder.delay, 0.0}); }
};

/// The settings of read_configuration().
Result<Settings> load_settings(const std::filesystem::path& file);
/// The same from text; `origin` stands for the file's name in errors.
Result<Settings> parse_settings(std::string_view toml, const std::string& origin);
/// A shipped file, scree.toml or a profile: its keys with default, unit, range and meaning.
std::string default_toml(std::string_view file);

/// Where a shipped or configured file lies: as given when absolute, else beside the configuration
/// file, else in <program>/../share/scree.
/// @param config_file empty without one
Result<std::filesystem::path> find_file(const std::string& name,
                                        const std::filesystem::path& config_file);

}  // namespace scree
