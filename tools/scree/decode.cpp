#include <spdlog/fmt/fmt.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.hpp"
#include "lidar_capture.hpp"
#include "scree/capture/pcd.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string capture, config, sensor, out, pcd;
};

/// CSV with the shortest digits that read back to the same number.
class CsvFile {
public:
  explicit CsvFile(const std::string& name) : name_(name.empty() ? "standard output" : name) {
    if (!name.empty()) {
      owned_.reset(std::fopen(name.c_str(), "wb"));
      if (!owned_) throw Failure("cannot write " + name);
    }
    text_.reserve(kFull + 256);
  }

  void line(std::string_view text) {
    text_ += text;
    end_line();
  }
  template <class T>
  void value(T value) {
    char digits[64];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    text_.append(digits, end);
    text_ += ',';
  }
  void end_line() {
    if (!text_.empty() && text_.back() == ',') text_.pop_back();
    text_ += '\n';
    if (text_.size() > kFull) flush();
  }
  void close() {
    flush();
    if (std::fflush(file()) != 0) throw Failure("cannot write " + name_);
  }

private:
  static constexpr std::size_t kFull = 1 << 20;

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::FILE* file() { return owned_ ? owned_.get() : stdout; }
  void flush() {
    if (std::fwrite(text_.data(), 1, text_.size(), file()) != text_.size()) {
      throw Failure("cannot write " + name_);
    }
    text_.clear();
  }

  std::string name_, text_;
  std::unique_ptr<std::FILE, Close> owned_;
};

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

void decode_lidar(const Options& options) {
  const Settings settings = capture_settings(options.capture, options.config);
  LidarCapture capture(options.capture, settings);
  if (!options.pcd.empty()) {
    std::error_code error;
    fs::create_directories(options.pcd, error);
    if (error) throw Failure("cannot make the folder " + options.pcd + ": " + error.message());
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
  csv.close();
  report_capture(capture, *stream);
}

}  // namespace

void add_decode(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("decode", "What the decoders read, as CSV");
  const auto options = std::make_shared<Options>();
  command->add_option("capture", options->capture, "Folder, .pcap or .pcapng")->required();
  command->add_option("--sensor", options->sensor, "Which sensor's values")
      ->required()
      ->check(CLI::IsMember({"lidar"}));
  command->add_option("--out", options->out, "CSV file; standard output when not given");
  command->add_option("--pcd", options->pcd,
                      "Folder for one PCD a sweep as well; of two equal dual returns it has one");
  command->add_option("--config", options->config,
                      "Configuration; the capture's own scree.toml when not given");
  command->callback([options] { decode_lidar(*options); });
}

}  // namespace scree::cli
