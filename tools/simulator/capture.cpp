#include "simulator/capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "scree/capture/pcap_writer.hpp"
#include "scree/capture/pcd.hpp"
#include "simulator/lidar.hpp"
#include "simulator/scene.hpp"
#include "simulator/truth.hpp"
#include "simulator/visibility.hpp"

namespace scree {
namespace {

constexpr std::int64_t kStartNs = 1598612520'000000000;  // 28 August 2020, 11:02 UTC
constexpr std::uint32_t kSensorAddress = 0xC0A801C9;     // 192.168.1.201, as Velodyne ships it
constexpr int kDataPacketsPerPosition = 5;

/// Datagrams as the host receives them: a moment after they were sent, never out of order.
class Wire {
public:
  Wire(PcapWriter& file, const LidarSettings& lidar, std::uint64_t seed)
      : file_(file), lidar_(lidar), random_(seed, 0x317E) {}

  void send(const SimulatedLidar& lidar) {
    const auto sent = lidar.packet_end_ns();
    write(sent, lidar_.port, lidar.data_packet());
    if (++packets_ % kDataPacketsPerPosition != 0) return;
    write(sent + 20'000, lidar_.position_port, lidar.position_packet());
  }

private:
  void write(std::int64_t sent_ns, int port, std::span<const std::uint8_t> payload) {
    const auto delay = static_cast<std::int64_t>(random_.uniform(100'000, 300'000));
    arrival_ns_ = std::max(arrival_ns_ + 1000, sent_ns + delay);
    const auto number = static_cast<std::uint16_t>(port);
    file_.write({arrival_ns_, kSensorAddress, number, number, payload});
  }

  PcapWriter& file_;
  LidarSettings lidar_;
  Random random_;
  std::int64_t arrival_ns_ = 0;
  int packets_ = 0;
};

/// Tells sweeps apart and notes at the end of each what has been seen.
class Observer {
public:
  Observer(const Terrain& terrain, Truth& truth) : visibility_(terrain), truth_(truth) {}

  void watch(const SimulatedLidar& lidar) {
    for (auto shots = lidar.shots(); !shots.empty(); shots = shots.subspan(velodyne::kLasers)) {
      const auto firing = shots.first(velodyne::kLasers);
      if (lidar.turns(firing.front().t_ns) >= sweeps_ + 1) {
        visibility_.end_sweep();
        truth_.visible.push_back({last_shot_ns_, visibility_.seen(), visibility_.not_seen()});
        ++sweeps_;
      }
      visibility_.add(firing);
      last_shot_ns_ = firing.back().t_ns;
    }
  }
  double sweeps() const { return sweeps_; }

private:
  Visibility visibility_;
  Truth& truth_;
  double sweeps_ = 0;
  std::int64_t last_shot_ns_ = 0;
};

Result<void> write_settings(const std::filesystem::path& file, const LidarSettings& lidar) {
  std::ofstream stream(file, std::ios::binary);
  stream << fmt::format(
      "[lidar]\nmodel = \"{}\"\nport = {}\nposition_port = {}\n"
      "translation = [{}, {}, {}]\nrpy_deg = [{}, {}, {}]\nmin_range = {}\nmax_range = {}\n",
      name_of(lidar.model), lidar.port, lidar.position_port, lidar.translation.x(),
      lidar.translation.y(), lidar.translation.z(), lidar.rpy_deg.x(), lidar.rpy_deg.y(),
      lidar.rpy_deg.z(), lidar.min_range, lidar.max_range);
  stream << std::flush;
  if (!stream) return fail(fmt::format("cannot write {}", file.string()));
  return {};
}

}  // namespace

Result<void> write_capture(const std::filesystem::path& folder, const CaptureSettings& settings,
                           const std::function<void(std::size_t)>& progress) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) {
    return fail(fmt::format("cannot make the folder {}: {}", folder.string(), failure.message()));
  }
  const LidarSettings mounted = scene_lidar();
  auto file = PcapWriter::create_ethernet(folder / "lidar.pcap");
  if (!file) return tl::make_unexpected(file.error());

  const Terrain terrain(scene_terrain(), settings.seed);
  const RayCaster caster(terrain);
  SimulatedLidarSettings lidar_settings;
  lidar_settings.model = mounted.model;
  lidar_settings.rate_hz = settings.rate_hz;
  if (settings.dual) lidar_settings.mode = velodyne::ReturnMode::dual;
  SimulatedLidar lidar(terrain, caster, lidar_settings, mounted.mount(), kStartNs, settings.seed);
  Wire wire(*file, mounted, settings.seed);
  Truth truth;
  Observer observer(terrain, truth);
  // The packet that begins the turn after the last one is there too, so that the last sweep ends.
  const double sweeps = std::max(std::round(settings.seconds * settings.rate_hz), 1.0);
  while (observer.sweeps() < sweeps) {
    lidar.advance();
    observer.watch(lidar);
    wire.send(lidar);
    progress(static_cast<std::size_t>(1000 *
                                      std::min(lidar.turns(lidar.packet_end_ns()) / sweeps, 1.0)));
  }
  constexpr std::int64_t kPoseStepNs = 10'000'000;
  for (std::int64_t t = kStartNs; t < lidar.packet_end_ns() + kPoseStepNs; t += kPoseStepNs) {
    truth.poses.push_back({t, Pose()});
  }
  if (auto closed = file->close(); !closed) return closed;
  if (auto written = write_settings(folder / "scree.toml", mounted); !written) return written;
  return write_truth(folder / "truth.json", terrain, truth);
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
  return write_truth(beside.replace_extension(".truth.json"), terrain, truth);
}

}  // namespace scree
