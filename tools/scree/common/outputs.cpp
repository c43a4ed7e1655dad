#include "common/outputs.hpp"

#include <algorithm>
#include <array>

#include "commands.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForce = ": --force overwrites it";

/// Whether a file is one that is read: itself, or part of a capture.
bool is_read(const fs::path& file, const fs::path& read) {
  std::error_code none;
  if (fs::equivalent(file, read, none)) return true;
  if (!fs::is_directory(read, none)) return false;
  constexpr std::array kParts = {"lidar.pcap", "lidar.pcapng", "lidar.lcm",  "imu.pcap",
                                 "imu.pcapng", "can.log",      "truth.json", "scree.toml"};
  return std::ranges::any_of(
      kParts, [&](const char* part) { return fs::equivalent(file, read / part, none); });
}

bool are_one(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(fs::absolute(a, none), none) ==
         fs::weakly_canonical(fs::absolute(b, none), none);
}

bool is_file(const fs::path& file) {
  std::error_code none;
  return !file.empty() && file != "-" && !fs::is_other(file, none);
}

}  // namespace

void Outputs::add_to(CLI::App& command) {
  command.add_flag("--force", force_, "overwrite what is there");
}

void Outputs::require_free(std::initializer_list<fs::path> files,
                           const std::vector<fs::path>& read) const {
  std::error_code none;
  for (const fs::path& file : files) {
    if (!is_file(file)) continue;
    if (std::ranges::any_of(read, [&](const fs::path& each) { return is_read(file, each); })) {
      throw Failure(file.string() + " is read: it cannot be written, too");
    }
    const auto same = std::ranges::count_if(
        files, [&](const fs::path& each) { return is_file(each) && are_one(file, each); });
    if (same > 1) throw Failure(file.string() + " cannot hold two outputs");
    // An empty file or folder, as mktemp makes it, has nothing to lose.
    const bool is_one = fs::is_regular_file(file, none) || fs::is_directory(file, none);
    if (!force_ && is_one && !fs::is_empty(file, none)) {
      throw Failure(file.string() + " is there already" + kForce);
    }
    if (file.has_parent_path() && !fs::is_directory(file.parent_path(), none)) {
      throw Failure("cannot write " + file.string() + ": there is no folder " +
                    file.parent_path().string());
    }
  }
}

void Outputs::require_empty(const fs::path& folder) const {
  std::error_code error;
  if (force_ || folder.empty() || !fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error) || !fs::is_empty(folder, error)) {
    throw Failure(folder.string() + " is there already, and not an empty folder" + kForce);
  }
}

}  // namespace scree::cli
