#include "scree/capture/capture.hpp"

namespace scree {

namespace fs = std::filesystem;

namespace {

/// The capture itself when it is a file, else <stem>.pcap or <stem>.pcapng in its folder.
Result<fs::path> pcap_of(const fs::path& capture, const std::string& stem) {
  std::error_code ignored;
  if (!fs::exists(capture, ignored)) return fail(capture.string() + ": no such file or folder");
  if (!fs::is_directory(capture, ignored)) return capture;
  for (const char* ending : {".pcap", ".pcapng"}) {
    if (fs::exists(capture / (stem + ending), ignored)) return capture / (stem + ending);
  }
  return fail(capture.string() + ": the folder has no " + stem + ".pcap");
}

}  // namespace

Result<fs::path> lidar_file(const fs::path& capture) {
  return pcap_of(capture, "lidar");
}

Result<fs::path> imu_file(const fs::path& capture) {
  return pcap_of(capture, "imu");
}

std::optional<fs::path> settings_file(const fs::path& capture, const fs::path& given) {
  if (!given.empty()) return given;
  std::error_code ignored;
  if (fs::is_directory(capture, ignored) && fs::exists(capture / "scree.toml", ignored)) {
    return capture / "scree.toml";
  }
  return std::nullopt;
}

Result<fs::path> can_file(const fs::path& capture) {
  std::error_code ignored;
  if (!fs::exists(capture, ignored)) return fail(capture.string() + ": no such file or folder");
  if (!fs::is_directory(capture, ignored)) return capture;
  if (fs::exists(capture / "can.log", ignored)) return capture / "can.log";
  return fail(capture.string() + ": the folder has no can.log");
}

}  // namespace scree
