#include "common/outputs.hpp"

#include "commands.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kForce = ": --force overwrites it";

}  // namespace

void Outputs::add_to(CLI::App& command) {
  command.add_flag("--force", force_, "overwrite what is there");
}

void Outputs::require_free(std::initializer_list<fs::path> files) const {
  std::error_code none;
  for (const fs::path& file : files) {
    if (file.empty() || file == "-") continue;
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
