#include "simulator/capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "scree/capture/pcap_writer.hpp"
#include "scree/capture/pcd.hpp"
#include "simulator/links.hpp"
#include "simulator/truth.hpp"

namespace scree {
namespace {

/// What the IMU answers while its driver sets it up.
void greet(SerialPort& port, std::int64_t t_ns) {
  constexpr std::int64_t kPause = 50'000'000;
  using xsens::MessageId;
  t_ns -= 4 * kPause;
  for (const MessageId id :
       {MessageId::wake_up, MessageId::go_to_config_ack, MessageId::go_to_measurement_ack}) {
    port.send(t_ns, xbus_message(id, {}));
    t_ns += kPause;
  }
}

Result<void> write_imu(const std::filesystem::path& file, const Drive& drive, std::int64_t end_ns) {
  const CaptureSettings& settings = drive.settings;
  auto pcap = PcapWriter::create_serial(file);
  if (!pcap) return tl::make_unexpected(pcap.error());
  Random random(settings.seed, 0x1A2);
  const std::int64_t start = kDriveStartNs - static_cast<std::int64_t>(random.uniform(0, 2e8));
  // The filter and the device's queue hold a sample back for a moment.
  const auto held_back = static_cast<std::int64_t>(random.uniform(1e6, 4e6));
  SimulatedImu imu(drive.motion, drive.robot.imu_mount(), draw_imu(settings), start, settings.seed);
  constexpr std::int64_t kBurstNs = 16'000'000;
  SerialPort port(*pcap, drive.robot.imu.baud, settings.imu_bursts ? kBurstNs : 0, settings.seed);
  greet(port, start);
  port.corrupt(settings.faults.imu_corruption);
  for (ImuMessage sample = imu.next(); sample.t_ns < end_ns; sample = imu.next()) {
    if (settings.faults.imu_gap.holds(since_start(sample.t_ns))) continue;
    port.send(sample.t_ns + held_back, mt_data2(sample));
  }
  port.finish();
  return pcap->close();
}

Result<void> write_can(const std::filesystem::path& file, const Drive& drive, std::int64_t end_ns) {
  auto log = CanLogWriter::create(file);
  if (!log) return tl::make_unexpected(log.error());
  const SimulatedEncoderSettings drawn = draw_encoder(drive.settings);
  SimulatedEncoder encoder(drive.motion, drive.robot.encoder, drawn, drive.settings.seed);
  CanBus bus(*log, drive.robot.encoder, drive.settings.seed);
  bus.lose_encoder([gap = drive.settings.faults.encoder_gap](std::int64_t t_ns) {
    return gap.holds(since_start(t_ns));
  });
  bus.start(kDriveStartNs - 50'000'000, drawn.rate_hz);
  bus.run_until(end_ns, encoder);
  return log->close();
}

/// Writes lidar.pcap and what it has shown. Returns the time of its end.
Result<std::int64_t> write_lidar(const std::filesystem::path& file, const Drive& drive,
                                 Truth& truth, const std::function<void(std::size_t)>& progress) {
  const auto& [settings, robot, terrain, motion, movers] = drive;
  auto pcap = PcapWriter::create_ethernet(file);
  if (!pcap) return tl::make_unexpected(pcap.error());
  const RayCaster caster(terrain);
  SimulatedLidar lidar(terrain, caster, draw_lidar(settings, robot.lidar), motion,
                       robot.lidar.mount(), kDriveStartNs, settings.seed, movers);
  Ethernet ethernet(*pcap, robot.lidar, settings.faults.packet_loss, settings.seed);
  Observer observer(drive, truth);
  // The packet that begins the turn after the last one is there too, so that the last sweep ends.
  const double turns = std::max(std::round(settings.seconds * settings.rate_hz), 1.0);
  while (observer.turns() < turns) {
    lidar.advance();
    observer.watch(lidar);
    ethernet.send(lidar);
    const double done = std::min(lidar.turns(lidar.packet_end_ns()) / turns, 1.0);
    progress(static_cast<std::size_t>(1000 * done));
  }
  if (auto closed = pcap->close(); !closed) return tl::make_unexpected(closed.error());
  return lidar.packet_end_ns();
}

}  // namespace

Result<void> write_capture(const std::filesystem::path& folder, const CaptureSettings& settings,
                           const std::function<void(std::size_t)>& progress) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    return fail(fmt::format("cannot make the folder {}: {}", folder.string(), failure.message()));
  }
  const Drive drive(settings);
  if (auto written = write_robot(folder / "scree.toml", drive.robot); !written) return written;
  Truth truth;
  const auto end = write_lidar(folder / "lidar.pcap", drive, truth, progress);
  if (!end) return tl::make_unexpected(end.error());
  constexpr std::int64_t kTail = 50'000'000;  // the other sensors outlive the last sweep
  for (const auto write : {write_imu, write_can}) {
    const char* name = write == write_imu ? "imu.pcap" : "can.log";
    if (auto written = write(folder / name, drive, *end + kTail); !written) {
      return written;
    }
  }
  constexpr std::int64_t kPoseStepNs = 10'000'000;
  for (std::int64_t t = kDriveStartNs; t < *end + kPoseStepNs; t += kPoseStepNs) {
    truth.poses.push_back({t, drive.motion.base(t)});
  }
  truth.obstacles = true_obstacles(drive.terrain, drive.movers);
  return write_truth(folder / "truth.json", truth);
}

Result<void> write_cloud(const std::filesystem::path& file, const CloudSettings& settings,
                         std::uint64_t seed, const TerrainSettings& terrain_settings) {
  const Terrain terrain(terrain_settings, seed);
  const PointCloud cloud = reconstructed_cloud(terrain, settings, seed);
  if (auto written = write_pcd(file, cloud); !written) return written;
  Truth truth;
  truth.poses.push_back({0, Pose()});
  truth.visible.push_back({0, obstacle_ids(terrain), small_ids(terrain)});
  std::filesystem::path beside = file;
  truth.obstacles = true_obstacles(terrain);
  return write_truth(beside.replace_extension(".truth.json"), truth);
}

}  // namespace scree
