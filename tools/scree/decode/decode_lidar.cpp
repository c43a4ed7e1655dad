#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "decode/csv_file.hpp"
#include "decode/decode.hpp"
#include "read/lidar_capture.hpp"
#include "scree/capture/pcd.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

void write_returns(const velodyne::DecodedPacket& packet, CsvFile& csv) {
  const velodyne::Shots& shots = packet.shots;
  for (std::size_t shot = 0; shot < velodyne::kShots; ++shot) {
    if (shots.range[shot] == 0.0F) continue;
    csv.value(packet.time_ns + shots.time_ns[shot]);
    csv.value(packet.index);
    csv.value(velodyne::block_of(shot));
    csv.value(velodyne::laser_of(shot));
    csv.value(shots.azimuth[shot] / 100.0F);
    csv.value(shots.range[shot]);
    csv.value(static_cast<int>(shots.reflectivity[shot]));
    csv.value(shots.x[shot]);
    csv.value(shots.y[shot]);
    csv.value(shots.z[shot]);
    csv.end_line();
  }
}

}  // namespace

void decode_lidar(const DecodeOptions& options) {
  const Settings settings = capture_settings(options.capture, options.config);
  const HostSteps steps = find_host_steps(options.capture, settings.lidar);
  LidarCapture capture(options.capture, settings, steps);
  if (!options.pcd.empty()) {
    std::error_code error;
    fs::create_directories(options.pcd, error);
    if (error) throw Failure("cannot make the folder " + options.pcd + ": " + error.message());
    Outputs::remove_sweeps(options.pcd);
  }
  CsvFile csv(options.out);
  csv.line("t_ns,packet,block,channel,azimuth_deg,range_m,reflectivity,x,y,z");
  int sweeps = 0;
  const auto on_sweep = [&](Sweep& sweep) {
    if (options.pcd.empty()) return;
    const fs::path file = fs::path(options.pcd) / fmt::format("sweep_{:06}.pcd", sweeps++);
    if (const auto written = write_pcd(file, sweep.points); !written) {
      throw Failure(written.error().message);
    }
  };
  const auto on_packet = [&](const velodyne::DecodedPacket& packet) { write_returns(packet, csv); };
  const auto stream = std::make_unique<velodyne::LidarStream>(settings.lidar, on_sweep, on_packet);
  capture.play(*stream);
  report_capture(capture, *stream);
  csv.close();
  say(steps);
}

}  // namespace scree::cli
