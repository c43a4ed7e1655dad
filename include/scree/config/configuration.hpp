#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// Where a value stands.
struct Source {
  std::string file;  ///< empty: nowhere, it is the default
  std::uint32_t line = 0;

  bool is_default() const { return file.empty(); }
  std::string text() const;  ///< "FILE:LINE" or "default"
};

/// Settings, and where each comes from.
struct Configuration {
  Settings settings;
  std::map<std::string, Source, std::less<>> sources;  ///< of what is written, by "table.key"

  Source source_of(std::string_view name) const;
};

struct NamedFile {
  std::string_view key;
  std::string name;
};
/// The files that keys name: weights and a DBC file; a name is empty where there is none.
std::vector<NamedFile> named_files(const Settings& settings);

/// Reads a TOML file over the defaults, then the drop-ins over it: of scree.toml the files
/// scree.d/*.toml beside it, in the order of their names. The error names file, line and key, what
/// is accepted, and for an unknown key the nearest one.
Result<Configuration> read_configuration(const std::filesystem::path& file);

/// Every key with its value and, as a remark, where that comes from: TOML that can be read back.
/// @param only_set leaves out the defaults
std::string effective_toml(const Configuration& configuration, bool only_set);

}  // namespace scree
