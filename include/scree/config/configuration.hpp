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
  std::string file;  ///< empty: nowhere
  std::uint32_t line = 0;
  bool says_default = false;     ///< a profile that says what the program has anyway
  std::string_view method = {};  ///< that was chosen when it was read, as Key::method

  /// Whether nobody has chosen the value.
  bool is_default() const { return file.empty() || says_default; }
  std::string text() const;  ///< "FILE:LINE", or "default" where it stands nowhere
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

/// What is wrong with the value of a key.
struct KeyMistake {
  std::string key, reason;
};
/// What those who will use the values say of them, which the table of keys cannot judge.
using Judge = std::function<std::vector<KeyMistake>(const Configuration&)>;

/// Reads the profiles, over them a TOML file, and over it the drop-ins: of scree.toml the files
/// scree.d/*.toml beside it, in the order of their names. A profile (cloud.toml, map.toml,
/// sweep.toml) is the file of that name beside the TOML file, else the shipped one. The error has a
/// line for each mistake, in the order of files and lines: it names file, line and key, what is
/// accepted, and for an unknown key the nearest one.
Result<Configuration> read_configuration(const std::filesystem::path& file,
                                         const Judge& judge = {});

enum class Shown : std::uint8_t {
  owners,  ///< what a robot's owner sets, and all that a file sets
  all,
  set  ///< only what a file sets
};
/// Keys with their values and, as remarks, where these come from: TOML that can be read back.
std::string effective_toml(const Configuration& configuration, Shown shown);

/// Every key that is read, as "table.key", with its value as TOML.
std::map<std::string, std::string, std::less<>> toml_values(const Settings& settings);

}  // namespace scree
