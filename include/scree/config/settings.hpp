#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "scree/core/pose.hpp"
#include "scree/core/result.hpp"

namespace scree {

enum class LidarModel : std::uint8_t { vlp16, puck_lite, puck_hires };
enum class ByteOrder : std::uint8_t { little_endian, big_endian };
enum class EncoderKind : std::uint8_t { counter, speed };
/// What heights are measured from: the median of a ring around each cluster (the paper's way, as
/// far as it says), or the ground's surface under it.
enum class GroundReference : std::uint8_t { ring, surface };
/// Which points clusters are made of: the paper's edge points, or all that stand above or lie below
/// the ground's surface.
enum class Candidates : std::uint8_t { edges, bodies };
enum class ClusterMethod : std::uint8_t { supervoxel, euclidean, regions };

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
inline constexpr std::array kNames<GroundReference> = {
    std::pair{std::string_view("ring"), GroundReference::ring},
    std::pair{std::string_view("surface"), GroundReference::surface}};
template <>
inline constexpr std::array kNames<Candidates> = {
    std::pair{std::string_view("edges"), Candidates::edges},
    std::pair{std::string_view("bodies"), Candidates::bodies}};
template <>
inline constexpr std::array kNames<ClusterMethod> = {
    std::pair{std::string_view("supervoxel"), ClusterMethod::supervoxel},
    std::pair{std::string_view("euclidean"), ClusterMethod::euclidean},
    std::pair{std::string_view("regions"), ClusterMethod::regions}};

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

struct ImuSettings {
  std::string device = "/dev/ttyUSB0";
  int baud = 921600;
  bool configure = true;
  int rate = 100;
  int acceleration_hr_rate = 0;
  int gyro_hr_rate = 0;
  Eigen::Vector3d rpy_deg{0, 0, 0};
  Eigen::Vector3d translation{0, 0, 0};

  /// `imu` in `base`.
  Pose mount() const {
    return {translation,
            from_roll_pitch_yaw(radians(rpy_deg.x()), radians(rpy_deg.y()), radians(rpy_deg.z()))};
  }
};

struct EncoderSettings {
  std::string interface = "can0";
  std::string dbc, signal;
  std::int64_t can_id = 0x1A0;
  int start_bit = 0;
  int length = 32;
  ByteOrder byte_order = ByteOrder::little_endian;
  bool is_signed = true;
  EncoderKind kind = EncoderKind::counter;
  double scale = 0.000157;
  double max_speed = 5.0;
  double max_acceleration = 10.0;

  // No keys: what only a DBC file says, filled in by encoder::with_dbc().
  bool is_extended = false;       ///< 29 bits although can_id is not above 0x7FF
  double factor = 1, offset = 0;  ///< scale multiplies raw * factor + offset

  bool has_extended_id() const { return is_extended || can_id > 0x7FF; }
  /// Bytes that a frame must have to hold the signal.
  int frame_bytes() const {
    if (byte_order == ByteOrder::little_endian) return (start_bit + length + 7) / 8;
    // In the first byte the signal has the bits from its start downwards, then whole bytes follow.
    return start_bit / 8 + 1 + std::max(length - start_bit % 8 - 1 + 7, 0) / 8;
  }
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
  int max_points = 1 << 16;
  int max_voxels = 1 << 19;
};

/// Obstacles followed from list to list.
struct TrackingSettings {
  /// What is found in a list is published as it is, and gone when the next one has it no more: only
  /// its id stays as long.
  static TrackingSettings for_sweep();

  std::string network = "network_track.txt";
  std::uint32_t least_found = 2;  ///< lists that have a published obstacle
  double smoothing = 0.4;
  double appear = 0.35;
  double disappear = 0.25;
  double remember = 1.0;
  double reach = 10;
};

/// The stages of the paper and ours beside them. There is one set for reconstructed clouds, one for
/// the map that grows while driving, and one for single sweeps, because every length follows the
/// density of the points.
struct DetectSettings {
  int max_points = 1 << 20;
  int max_edge_points = 1 << 18;
  int max_obstacles = 256;

  bool voxel_grid = true;
  double leaf_size = 0.0592;
  double clearance = 2.0;

  GroundReference ground = GroundReference::ring;
  int max_ground_cells = 1 << 19;
  double ground_cell = 0.08;
  double ground_points = 2.15;
  double ground_slope = 0.34;
  double ground_tolerance = 0.10;
  double ground_trend = 0;

  Candidates candidates = Candidates::edges;
  double body_height = 0.06;

  double kernel_spacing = 0.10;
  double kernel_radius = 0.11;
  double kernel_bandwidth = 2.0;
  int kernel_neighbours = 1;
  double kernel_shared = 0;
  double edge_threshold = 0.35;

  bool suppression = true;
  double suppression_distance = 0.10;
  double suppression_radius = 0.11;

  ClusterMethod cluster_method = ClusterMethod::supervoxel;
  double saddle = 0.4;
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

  std::string network = "network_paper.txt";
  double min_confidence = 0.5;

  bool uses_surface() const {
    return ground == GroundReference::surface || candidates == Candidates::bodies;
  }

  /// The method as the paper has it, on clouds as dense as the paper's: the defaults above.
  static DetectSettings for_paper() { return {}; }
  static DetectSettings for_cloud();
  static DetectSettings for_map();
  static DetectSettings for_sweep();
};

struct LcmSettings {
  std::string url = "udpm://239.255.76.67:7667?ttl=0";
};

struct Settings {
  LidarSettings lidar;
  ImuSettings imu;
  EncoderSettings encoder;
  GpioSettings gpio;
  StopSettings stop;
  DetectSettings detect_cloud = DetectSettings::for_cloud();
  DetectSettings detect_map = DetectSettings::for_map();
  DetectSettings detect_sweep = DetectSettings::for_sweep();
  MapSettings map;
  TrackingSettings track;
  LcmSettings lcm;

  /// Of the longest list that is published.
  int max_obstacles() const {
    return std::max(detect_map.max_obstacles, detect_sweep.max_obstacles);
  }
};

/// The settings of read_configuration().
Result<Settings> load_settings(const std::filesystem::path& file);
/// The same from text; `origin` stands for the file's name in errors.
Result<Settings> parse_settings(std::string_view toml, const std::string& origin);
/// Every key with its default, unit, range and meaning, as a complete commented TOML file.
std::string default_settings_toml();

/// Where a shipped or configured file lies: as given when absolute, else beside the configuration
/// file, else in <program>/../share/scree.
/// @param config_file empty without one
Result<std::filesystem::path> find_file(const std::string& name,
                                        const std::filesystem::path& config_file);

}  // namespace scree
