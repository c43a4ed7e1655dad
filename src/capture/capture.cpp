#include "scree/capture/capture.hpp"

namespace scree {

namespace fs = std::filesystem;

Result<fs::path> lidar_file(const fs::path& capture) {
  std::error_code ignored;
  if (!fs::exists(capture, ignored)) return fail(capture.string() + ": no such file or folder");
  if (!fs::is_directory(capture, ignored)) return capture;
  for (const char* name : {"lidar.pcap", "lidar.pcapng"}) {
    if (fs::exists(capture / name, ignored)) return capture / name;
  }
  return fail(capture.string() + ": the folder has no lidar.pcap");
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
