#include "scree/capture/capture.hpp"

#include <array>
#include <fstream>
#include <initializer_list>
#include <utility>

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
  return fail(capture.string() + ": the folder has no " + *names.begin());
}

}  // namespace

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

std::optional<fs::path> settings_file(const fs::path& capture, const fs::path& given) {
  if (!given.empty()) return given;
  std::error_code ignored;
  if (fs::is_directory(capture, ignored) && fs::exists(capture / "scree.toml", ignored)) {
    return capture / "scree.toml";
  }
  return std::nullopt;
}

}  // namespace scree
