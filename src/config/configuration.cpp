#include "scree/config/configuration.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "contradiction.hpp"
#include "key_reader.hpp"
#include "mistakes.hpp"
#include "scree/config/keys.hpp"
#include "scree/core/byte_order_mark.hpp"
#include "scree/core/read_file.hpp"

namespace scree {
namespace {

/// A key stands on one line, so this also bounds how long keys are and how deep `a.b.c = 1` goes:
/// a table is destroyed by recursion, and each level takes stack.
bool has_short_lines(std::string_view toml, const std::string& origin, Mistakes& mistakes) {
  constexpr std::size_t kLongestLine = 1000;
  for (std::uint32_t line = 1; !toml.empty(); ++line) {
    const std::size_t length = std::min(toml.find('\n'), toml.size());
    if (length > kLongestLine) {
      mistakes.add(
          origin, line,
          fmt::format("the line has {} characters, {} are the most", length, kLongestLine));
      return false;
    }
    toml.remove_prefix(std::min(length + 1, toml.size()));
  }
  return true;
}

/// The end of the string that begins at `at`, or of its line where it has none.
std::size_t end_of_string(std::string_view toml, std::size_t at) {
  const char quote = toml[at];
  const std::string_view mark = toml.substr(at, 3);
  const bool is_long = mark == std::string(3, quote);
  for (at += is_long ? 3 : 1; at < toml.size(); ++at) {
    if (is_long ? toml.substr(at, 3) == mark : toml[at] == quote) return at + (is_long ? 3 : 1);
    if (toml[at] == '\\' && quote == '"') ++at;
    if (at < toml.size() && toml[at] == '\n' && !is_long) return at;
  }
  return toml.size();
}

/// Elsewhere a quote is a mistake, and what follows it is no string.
bool begins_string(std::string_view toml, std::size_t at) {
  const bool is_quote = toml[at] == '"' || toml[at] == '\'';
  return is_quote &&
         (at == 0 || std::string_view(" \t\r\n=,[{.").find(toml[at - 1]) != std::string_view::npos);
}

/// Outside strings and remarks TOML is ASCII. What the library does with other characters there is
/// undefined (toml++ 3.3, is_non_ascii_horizontal_whitespace()).
bool is_ascii_outside_strings(std::string_view toml, const std::string& origin,
                              Mistakes& mistakes) {
  for (std::size_t at = toml.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
       at < toml.size();) {
    if (toml[at] == '#') {
      at = std::min(toml.find('\n', at), toml.size());
    } else if (begins_string(toml, at)) {
      at = end_of_string(toml, at);
    } else if (static_cast<unsigned char>(toml[at]) < 0x80) {
      ++at;
    } else {
      const auto line =
          1 + std::count(toml.begin(), toml.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      mistakes.add(origin, static_cast<std::uint32_t>(line),
                   "a letter that is not of ASCII stands outside quotes and remarks");
      return false;
    }
  }
  return true;
}

/// Reads one file's text over the configuration. @return whether it is TOML
bool read_over(std::string_view toml, const std::string& origin, Configuration& configuration,
               Mistakes& mistakes) {
  mistakes.begin_file(origin);
  if (!has_short_lines(toml, origin, mistakes)) return false;
  if (!is_ascii_outside_strings(toml, origin, mistakes)) return false;
  try {
    const toml::table root = toml::parse(toml, origin);
    KeyReader reader(root, origin, configuration, mistakes);
    for_every_key(configuration.settings, reader);
    reader.refuse_unknown(root, "");
    return true;
  } catch (const toml::parse_error& error) {
    mistakes.add(origin, error.source().begin.line, error.description());
    return false;
  }
}

bool read_over(const std::filesystem::path& file, Configuration& configuration,
               Mistakes& mistakes) {
  constexpr std::uintmax_t kLargestFile = 1 << 20;
  const auto text = read_file(file, kLargestFile);
  if (text) return read_over(*text, file.string(), configuration, mistakes);
  mistakes.begin_file(file.string());
  mistakes.add(file.string(), text.error().message);
  return false;
}

/// Keys that one file sets and another one's choice of a method leaves unread.
void find_unread_keys(const Configuration& configuration, Mistakes& mistakes) {
  std::map<std::string, std::string_view> live;  // with their methods
  for_each_key(configuration.settings,
               [&](const Key& key, const auto&) { live.emplace(full_name(key), key.method); });
  for (const auto& [name, source] : configuration.sources) {
    if (source.is_default()) continue;
    const auto key = live.find(name);
    if (key != live.end() && key->second == source.method) continue;
    mistakes.add(source.file, source.line,
                 fmt::format("{} was set for {}, and another file sets another one", name,
                             source.method.empty() ? "another method" : source.method));
  }
}

/// What only all files together can have wrong.
/// @param origin stands for a place that no file sets
void judge_together(const Configuration& configuration, const std::string& origin,
                    Mistakes& mistakes) {
  const auto add = [&](const std::vector<std::string>& keys, const std::string& sentence) {
    for (const std::string& key : keys) {
      const Source source = configuration.source_of(key);
      if (!source.is_default()) return mistakes.add(source.file, source.line, sentence);
    }
    mistakes.add(origin, 0, sentence);
  };
  // The default is that of one wheel's counts and right for no DBC file.
  if (!configuration.settings.encoder.dbc.empty() &&
      configuration.source_of("encoder.scale").is_default()) {
    add({"encoder.dbc"},
        "encoder.dbc needs encoder.scale beside it, metres (or m/s) per unit of the signal: "
        "0.277778 for km/h");
  }
  find_unread_keys(configuration, mistakes);
  for (const Contradiction& found : contradictions(configuration.settings)) {
    add(found.keys, found.reason);
  }
}

/// Reads the profiles that lie beside the configuration file, else those shipped. What they say is
/// a default where it is that of the program.
bool read_profiles(const std::filesystem::path& config_file, Configuration& configuration,
                   Mistakes& mistakes) {
  bool is_toml = true;
  for (const std::string_view name : kProfiles) {
    const auto profile = find_file(std::string(name), config_file);
    if (profile) is_toml = read_over(*profile, configuration, mistakes) && is_toml;
  }
  const auto defaults = toml_values(Settings()), values = toml_values(configuration.settings);
  for (auto& [name, source] : configuration.sources) {
    const auto by_default = defaults.find(name), value = values.find(name);
    source.says_default = by_default != defaults.end() && value != values.end() &&
                          by_default->second == value->second;
  }
  return is_toml;
}

std::vector<std::filesystem::path> drop_ins(std::filesystem::path file) {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(file.replace_extension(".d"), none)) {
    // Hidden files are those of editors and other systems.
    const bool is_hidden = entry.path().filename().string().starts_with('.');
    if (entry.path().extension() == ".toml" && !is_hidden) found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// Files that keys name and that are not there; those of the defaults come with Scree.
void find_missing_files(const Configuration& configuration,
                        const std::filesystem::path& config_file, Mistakes& mistakes) {
  for (const auto& [key, name] : named_files(configuration.settings)) {
    const Source source = configuration.source_of(key);
    if (source.is_default() || name.empty()) continue;
    if (const auto found = find_file(name, config_file); !found) {
      mistakes.add(source.file, source.line, fmt::format("{}: {}", key, found.error().message));
    }
  }
}

}  // namespace

std::string Source::text() const {
  return file.empty() ? "default" : fmt::format("{}:{}", file, line);
}

Source Configuration::source_of(std::string_view name) const {
  const auto found = sources.find(name);
  return found == sources.end() ? Source() : found->second;
}

std::vector<NamedFile> named_files(const Settings& settings) {
  return {{"encoder.dbc", settings.encoder.dbc},
          {"detect.cloud.network", settings.detect_cloud.network},
          {"detect.map.network", settings.detect_map.network},
          {"detect.sweep.network", settings.detect_sweep.network},
          {"track.network", settings.track.network}};
}

Result<Configuration> read_configuration(const std::filesystem::path& file, const Judge& judge) {
  Configuration configuration;
  Mistakes mistakes;
  bool is_toml = read_profiles(file, configuration, mistakes);
  is_toml = read_over(file, configuration, mistakes) && is_toml;
  for (const std::filesystem::path& drop_in : drop_ins(file)) {
    is_toml = read_over(drop_in, configuration, mistakes) && is_toml;
  }
  if (is_toml) {  // else the settings are not what somebody meant
    judge_together(configuration, file.string(), mistakes);
    find_missing_files(configuration, file, mistakes);
    for (const auto& [key, reason] : judge ? judge(configuration) : std::vector<KeyMistake>()) {
      const Source source = configuration.source_of(key);
      mistakes.add(source.file.empty() ? file.string() : source.file, source.line,
                   fmt::format("{}: {}", key, reason));
    }
  }
  if (!mistakes.empty()) return tl::make_unexpected(mistakes.error());
  return configuration;
}

Result<Settings> load_settings(const std::filesystem::path& file) {
  auto configuration = read_configuration(file);
  if (!configuration) return tl::make_unexpected(configuration.error());
  return configuration->settings;
}

Result<Settings> parse_settings(std::string_view toml, const std::string& origin) {
  Configuration configuration;
  Mistakes mistakes;
  if (read_over(toml, origin, configuration, mistakes)) {
    judge_together(configuration, origin, mistakes);
  }
  if (!mistakes.empty()) return tl::make_unexpected(mistakes.error());
  return configuration.settings;
}

}  // namespace scree
