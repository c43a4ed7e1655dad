#include "scree/capture/capture.hpp"

#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "scree/core/lower_case.hpp"

namespace scree {

namespace fs = std::filesystem;

namespace {

/// The capture itself when it is a file, else the first of these names that is in its folder.
Result<fs::path> file_of(const fs::path& capture, std::initializer_list<const char*> names) {
  std::error_code ignored, error;
  if (!fs::exists(capture, error)) {
    return fail(capture.string() + ": " + (error ? error.message() : "no such file or folder"));
  }
  if (!fs::is_directory(capture, ignored)) return capture;
  for (const char* name : names) {
    if (fs::exists(capture / name, error)) return capture / name;
    if (error) return fail((capture / name).string() + ": " + error.message());
  }
  return fail(capture.string() + ": the folder has no " + *names.begin() + other_files(capture));
}

/// Whether a file looks like the recording of a sensor.
bool is_recording(const fs::path& file) {
  constexpr std::array kSigns = {".pcap", ".cap", ".lcm", ".log", ".bag", ".mcap", "candump"};
  const std::string name = lower_case(file.filename().string());
  return std::ranges::find(kCaptureFiles, name) == kCaptureFiles.end() &&
         std::ranges::any_of(
             kSigns, [&](const char* sign) { return name.find(sign) != std::string::npos; });
}

}  // namespace

std::string other_files(const fs::path& capture) {
  constexpr std::size_t kMost = 3;
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(capture, error)) {
    if (is_recording(entry.path())) names.push_back(entry.path().filename().string());
  }
  if (names.empty()) return "";
  std::ranges::sort(names);
  names.resize(std::min(names.size(), kMost));
  return fmt::format("; it has {}: give what belongs to it the name that it should have",
                     fmt::join(names, ", "));
}

Result<fs::path> lidar_file(const fs::path& capture) {
  return file_of(capture, {"lidar.pcap", "lidar.pcapng", "lidar.lcm"});
}

Result<fs::path> imu_file(const fs::path& capture) {
  return file_of(capture, {"imu.pcap", "imu.pcapng"});
}

Result<fs::path> can_file(const fs::path& capture) {
  return file_of(capture, {"can.log"});
}

std::string_view packed_with(const fs::path& file) {
  using namespace std::string_view_literals;
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kPackers = {
      {{"\x1F\x8B"sv, "gzip"},
       {"BZh"sv, "bzip2"},
       {"\xFD"
        "7zXZ\0"sv,
        "xz"},
       {"\x28\xB5\x2F\xFD"sv, "zstd"},
       {"PK\x03\x04"sv, "zip"}}};
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 8> head{};
  stream.read(head.data(), head.size());
  const std::string_view begin(head.data(), static_cast<std::size_t>(stream.gcount()));
  for (const auto& [magic, packer] : kPackers) {
    if (begin.starts_with(magic)) return packer;
  }
  return {};
}

std::string other_kind(const fs::path& file) {
  using namespace std::string_view_literals;
  constexpr std::string_view kConvert = "convert it to PCD";
  constexpr std::string_view kImport = "`scree-py import` makes a capture of it";
  constexpr std::string_view kCandump = "log with candump -L";
  struct Kind {
    std::string_view begin, name, remedy;
  };
  constexpr std::array kKinds = {
      Kind{"# .pcd", "a point cloud (PCD)", "`scree detect` takes it"},
      Kind{"version ", "a point cloud (PCD)", "`scree detect` takes it"},
      Kind{"ply", "a point cloud (PLY)", kConvert},
      Kind{"lasf", "a point cloud (LAS)", kConvert},
      Kind{"astm-e57", "a point cloud (E57)", kConvert},
      Kind{"\x93numpy", "a NumPy array", kConvert},
      Kind{"#rosbag", "a ROS 1 bag", kImport},
      Kind{"sqlite format 3", "a ROS 2 bag's database", kImport},
      Kind{"\x89mcap", "an MCAP file", kImport},
      Kind{"logg", "a CAN log of Vector (BLF)", kCandump},
      Kind{"date ", "a CAN log of Vector (ASC)", kCandump},
      Kind{";$fileversion", "a CAN trace of PEAK (TRC)", kCandump},
      Kind{"\xfa\xff", "Xbus bytes of an IMU", "`scree record` writes them with their times"},
      Kind{"<!doctype", "a web page", "download the file itself"},
      Kind{"<html", "a web page", "download the file itself"},
  };
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 32> head{};
  stream.read(head.data(), head.size());
  const std::string begin = lower_case({head.data(), static_cast<std::size_t>(stream.gcount())});
  if (begin.starts_with("version https://git-lfs")) {
    return "it is a pointer of Git LFS: fetch the file itself with git lfs pull";
  }
  for (const Kind& kind : kKinds) {
    if (begin.starts_with(kind.begin)) return fmt::format("it is {}: {}", kind.name, kind.remedy);
  }
  return "";
}

std::optional<fs::path> settings_file(const fs::path& capture, const fs::path& given) {
  if (!given.empty()) return given;
  std::error_code ignored;
  if (fs::is_directory(capture, ignored) && fs::exists(capture / "scree.toml", ignored)) {
    return capture / "scree.toml";
  }
  return std::nullopt;
}

}  // namespace scree
