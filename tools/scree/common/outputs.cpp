#include "common/outputs.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "commands.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForce = ": --force overwrites it";

/// Whether a file is one that is read: itself, or part of a capture.
bool is_read(const fs::path& file, const fs::path& read) {
  std::error_code none;
  if (fs::equivalent(file, read, none)) return true;
  if (!fs::is_directory(read, none)) return false;
  return std::ranges::any_of(kCaptureFiles, [&](std::string_view part) {
    return fs::equivalent(file, read / part, none);
  });
}

bool are_one(const fs::path& a, const fs::path& b) {
  std::error_code none;
  return fs::weakly_canonical(fs::absolute(a, none), none) ==
         fs::weakly_canonical(fs::absolute(b, none), none);
}

bool is_file(const fs::path& file) {
  std::error_code none;
  return !file.empty() && !fs::is_other(file, none);
}

/// Whether a file can be written: it, and its folder, where it is made.
void require_writable(const fs::path& file) {
  std::error_code none;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file, none)) throw Failure(file.string() + " is a folder");
  if (!fs::is_directory(folder, none)) {
    throw Failure("cannot write " + file.string() + ": there is no folder " + folder.string());
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw Failure("cannot write " + file.string() + ": " + std::strerror(errno));
  }
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
    if (file == "-") throw Failure("- is no name of a file: ./- is one");
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
    require_writable(file);
  }
}

void Outputs::require_empty(const fs::path& folder) const {
  std::error_code error;
  if (force_ || folder.empty() || !fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error) || !fs::is_empty(folder, error)) {
    throw Failure(folder.string() + " is there already, and not an empty folder" + kForce);
  }
}

void Outputs::remove_sweeps(const fs::path& folder) {
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().filename().string().starts_with("sweep_")) fs::remove_all(entry.path(), none);
  }
}

}  // namespace scree::cli
