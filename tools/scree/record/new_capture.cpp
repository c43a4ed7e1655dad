#include "record/new_capture.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "commands.hpp"
#include "scree/capture/capture.hpp"
#include "scree/config/configuration.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

/// In quotes, as it stands in a TOML file.
void replace_quoted(std::string& toml, const std::string& name, const std::string& by) {
  bool found = false;
  for (const char quote : {'"', '\''}) {
    const std::string quoted = quote + name + quote;
    for (std::size_t at = 0; (at = toml.find(quoted, at)) != std::string::npos; at += by.size()) {
      toml.replace(at + 1, name.size(), by);
      found = true;
    }
  }
  if (!found) {
    throw Failure(
        fmt::format("cannot find \"{}\" in the configuration: write it without escapes", name));
  }
}

/// The file itself, or with drop-ins or profiles beside it what it and they come to.
std::string text_of(const fs::path& config, const Configuration& configuration) {
  const bool is_one_file = std::ranges::all_of(configuration.sources, [&](const auto& key) {
    return key.second.is_default() || key.second.file == config.string();
  });
  if (!is_one_file) return effective_toml(configuration, Shown::set);
  std::ifstream read(config, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(read), {}};
  if (!read) throw Failure("cannot read " + config.string());
  return text;
}

}  // namespace

void make_capture_folder(const fs::path& folder, const Outputs& outputs, const fs::path& config) {
  outputs.require_empty(folder);
  std::error_code none;
  for (const std::string_view name : kCaptureFiles) {
    const fs::path file = folder / name;
    if (!fs::equivalent(file, config, none)) fs::remove(file, none);
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Failure(fmt::format("cannot make {}: {}", folder.string(), error.message()));
}

void keep_config(const fs::path& config, const fs::path& folder) {
  const Configuration configuration = value_or_fail(read_configuration(config));
  std::string toml = text_of(config, configuration);
  std::set<std::string> names;
  for (const NamedFile& file : named_files(configuration.settings)) names.insert(file.name);
  for (const std::string& name : names) {
    const fs::path source = config.parent_path() / name;
    std::error_code error;
    if (!fs::is_regular_file(source, error)) continue;
    const fs::path copy = folder / source.filename();
    fs::copy_file(source, copy, error);
    if (error) {
      throw Failure(
          fmt::format("cannot copy {} to {}: {}", source.string(), copy.string(), error.message()));
    }
    if (source.filename() != name) replace_quoted(toml, name, source.filename());
  }
  const fs::path file = folder / "scree.toml";
  std::ofstream write(file, std::ios::binary);
  write << toml;
  write.close();
  if (!write) throw Failure(fmt::format("cannot copy {} to {}", config.string(), file.string()));
}

}  // namespace scree::cli
