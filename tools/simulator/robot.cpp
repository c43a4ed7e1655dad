#include "simulator/robot.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <fstream>

#include "scree/core/random.hpp"
#include "simulator/scene.hpp"

namespace scree {
namespace {

/// As a person would have measured it.
double rounded(double value, double unit) {
  return std::round(value / unit) * unit;
}

EncoderSettings draw_encoder(Random& random) {
  struct Layout {
    int start_bit, length;
    ByteOrder order;
    bool is_signed;
    EncoderKind kind;
    double scale;
  };
  constexpr std::array kLayouts = {
      Layout{7, 32, ByteOrder::big_endian, true, EncoderKind::counter, 0.000157},
      Layout{8, 16, ByteOrder::little_endian, false, EncoderKind::counter, 0.001},
      Layout{19, 24, ByteOrder::big_endian, true, EncoderKind::counter, 0.0005},
      Layout{12, 20, ByteOrder::little_endian, false, EncoderKind::counter, 0.0008},
      Layout{16, 16, ByteOrder::little_endian, true, EncoderKind::speed, 0.001}};
  const Layout& layout = kLayouts[random.index(kLayouts.size())];
  EncoderSettings encoder;
  encoder.can_id = random.chance(0.3) ? 0x18FF50E5 : 0x100 + static_cast<int>(random.index(0x200));
  encoder.start_bit = layout.start_bit;
  encoder.length = layout.length;
  encoder.byte_order = layout.order;
  encoder.is_signed = layout.is_signed;
  encoder.kind = layout.kind;
  encoder.scale = layout.scale;
  return encoder;
}

std::string list(const Eigen::Vector3d& values) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", values.x(), values.y(), values.z());
}

}  // namespace

Pose Robot::imu_mount() const {
  return {imu.translation, from_roll_pitch_yaw(radians(imu.rpy_deg.x()), radians(imu.rpy_deg.y()),
                                               radians(imu.rpy_deg.z()))};
}

Robot draw_robot(std::uint64_t seed) {
  Robot robot;
  robot.lidar = scene_lidar();
  robot.imu.translation = {0.05, 0, 0.30};
  Random random(seed, 0x20B0);
  if (random.chance(0.5)) return robot;
  robot.lidar.translation = {rounded(random.uniform(0, 0.3), 0.01),
                             rounded(random.uniform(-0.05, 0.05), 0.01),
                             rounded(random.uniform(0.75, 1.15), 0.01)};
  robot.lidar.rpy_deg = {rounded(random.uniform(-1, 1), 0.1), rounded(random.uniform(2, 10), 0.1),
                         rounded(random.uniform(-3, 3), 0.1)};
  constexpr std::array kTurned = {0.0, 0.0, 90.0, -90.0, 180.0};
  robot.imu.translation = {rounded(random.uniform(-0.2, 0.2), 0.01),
                           rounded(random.uniform(-0.1, 0.1), 0.01),
                           rounded(random.uniform(0.15, 0.5), 0.01)};
  robot.imu.rpy_deg = {rounded(random.uniform(-2, 2), 0.1), rounded(random.uniform(-2, 2), 0.1),
                       kTurned[random.index(kTurned.size())] + rounded(random.uniform(-2, 2), 0.1)};
  robot.encoder = draw_encoder(random);
  return robot;
}

Settings with_sensors_of(const Robot& robot, Settings settings) {
  settings.lidar = robot.lidar;
  settings.imu = robot.imu;
  settings.encoder = robot.encoder;
  return settings;
}

Result<void> write_robot(const std::filesystem::path& file, const Robot& robot) {
  const auto& [lidar, imu, encoder] = robot;
  std::ofstream stream(file, std::ios::binary);
  stream << fmt::format(
      "[lidar]\nmodel = \"{}\"\nport = {}\nposition_port = {}\ntranslation = {}\nrpy_deg = {}\n"
      "min_range = {:.1f}\nmax_range = {:.1f}\n\n",
      name_of(lidar.model), lidar.port, lidar.position_port, list(lidar.translation),
      list(lidar.rpy_deg), lidar.min_range, lidar.max_range);
  stream << fmt::format("[imu]\ndevice = \"{}\"\nbaud = {}\nrpy_deg = {}\ntranslation = {}\n\n",
                        imu.device, imu.baud, list(imu.rpy_deg), list(imu.translation));
  stream << fmt::format(
      "[encoder]\ninterface = \"{}\"\ncan_id = 0x{:X}\nstart_bit = {}\nlength = {}\n"
      "byte_order = \"{}\"\nsigned = {}\nkind = \"{}\"\nscale = {}\n",
      encoder.interface, encoder.can_id, encoder.start_bit, encoder.length,
      name_of(encoder.byte_order), encoder.is_signed, name_of(encoder.kind), encoder.scale);
  stream << std::flush;
  if (!stream) return fail(fmt::format("cannot write {}", file.string()));
  return {};
}

}  // namespace scree
