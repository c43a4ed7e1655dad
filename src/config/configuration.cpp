#include "scree/config/configuration.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>
#define TOML_EXCEPTIONS 1
#include <spdlog/fmt/fmt.h>
#include <toml++/toml.h>

#include "contradiction.hpp"
#include "scree/config/keys.hpp"
#include "scree/config/near_names.hpp"
#include "scree/config/removed_keys.hpp"
#include "scree/core/read_file.hpp"
#include "toml_string.hpp"

namespace scree {
namespace {

/// In quotes where it is no bare key: then "lidar.port" is not taken for port in lidar.
std::string part_of_name(std::string_view key) {
  const bool is_bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return is_bare ? std::string(key) : toml_string(key);
}

/// Reads one value at a time; keeps the first mistake.
class Reader {
public:
  Reader(const toml::table& root, std::string origin, Configuration& configuration)
      : root_(root), origin_(std::move(origin)), configuration_(configuration) {}

  template <class T>
  void operator()(const Key& key, T& value) {
    const std::string name = full_name(key);
    if (!key.is_live) {
      unread_.emplace(name, key.only_with);
      return;
    }
    known_.insert(name);
    const auto node = root_.at_path(name);
    if (!node || error_) return;
    configuration_.sources[name] = {
        .file = origin_, .line = node.node()->source().begin.line, .method = key.method};
    read(key, *node.node(), value);
  }

  /// Names the first key of the file that no setting has.
  void refuse_unknown(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      if (error_) return;
      const std::string name = (prefix.empty() ? "" : prefix + ".") + part_of_name(key.str());
      const auto longer = known_.lower_bound(name + ".");
      const bool is_table = longer != known_.end() && longer->starts_with(name + ".");
      if (is_table && node.is_table()) {
        refuse_unknown(*node.as_table(), name);
      } else if (is_table) {
        refuse(node, name, "is a table");
      } else if (!known_.contains(name)) {
        refuse(node, name, why_not(name, node.is_table()));
      }
    }
  }

  const std::optional<Error>& error() const { return error_; }

private:
  std::string why_not(const std::string& name, bool is_table) const {
    if (const auto unread = unread_.find(name); unread != unread_.end()) {
      return fmt::format("is read only with {}", unread->second);
    }
    if (const auto replacement = replacement_of(name)) return "is gone: " + *replacement;
    return "is not a setting; the nearest is " + nearest(name, is_table);
  }

  std::string nearest(std::string_view wanted, bool is_table) const {
    std::vector<std::string_view> names;
    for (const std::string& name : known_) {
      const std::string_view table = std::string_view(name).substr(0, name.rfind('.'));
      names.push_back(is_table ? table : name);
    }
    return near_names(wanted, names, 1);
  }

  void refuse(const toml::node& node, std::string_view name, std::string_view reason) {
    if (error_) return;
    error_ = Error{fmt::format("{}:{}: {} {}", origin_, node.source().begin.line, name, reason)};
  }

  void refuse_with_range(const Key& key, const toml::node& node, std::string_view reason) {
    refuse(node, full_name(key),
           fmt::format("{}, accepted is {} to {}{}{}", reason, key.low, key.high,
                       key.unit.empty() ? "" : " ", key.unit));
  }

  bool in_range(const Key& key, const toml::node& node, double value) {
    if (value >= key.low && value <= key.high) return true;
    refuse_with_range(key, node, fmt::format("= {} is out of range", value));
    return false;
  }

  template <class T>
  void read(const Key& key, const toml::node& node, T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      if (node.is_boolean()) {
        value = **node.as_boolean();
      } else {
        refuse(node, full_name(key), "must be true or false");
      }
    } else if constexpr (std::is_integral_v<T>) {
      if (!node.is_integer()) return refuse_with_range(key, node, "must be a whole number");
      const std::int64_t read = **node.as_integer();
      if (in_range(key, node, static_cast<double>(read))) value = static_cast<T>(read);
    } else if constexpr (std::is_same_v<T, double>) {
      if (!node.is_number()) return refuse_with_range(key, node, "must be a number");
      const double read = *node.value<double>();
      if (in_range(key, node, read)) value = read;
    } else if constexpr (std::is_same_v<T, std::string>) {
      if (!node.is_string()) return refuse(node, full_name(key), "must be a string in quotes");
      value = **node.as_string();
    } else if constexpr (std::is_same_v<T, Eigen::Vector3d>) {
      read_vector(key, node, value);
    } else if constexpr (std::is_same_v<T, std::vector<BodyBox>>) {
      read_boxes(key, node, value);
    } else {
      read_choice(key, node, value);
    }
  }

  void read_vector(const Key& key, const toml::node& node, Eigen::Vector3d& value) {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != 3) {
      return refuse_with_range(key, node, "must be three numbers, [x, y, z]");
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const toml::node& element = *array->get(i);
      if (!element.is_number()) return refuse_with_range(key, element, "must be three numbers");
      const double read = *element.value<double>();
      if (!in_range(key, element, read)) return;
      value[static_cast<Eigen::Index>(i)] = read;
    }
  }

  void read_boxes(const Key& key, const toml::node& node, std::vector<BodyBox>& value) {
    constexpr std::size_t kMostBoxes = 64;
    constexpr std::string_view kForm = "must be boxes, [[[x, y, z], [x, y, z]], ...]";
    const toml::array* boxes = node.as_array();
    if (boxes == nullptr) return refuse_with_range(key, node, kForm);
    if (boxes->size() > kMostBoxes) {
      return refuse(node, full_name(key),
                    fmt::format("has {} boxes, {} are the most", boxes->size(), kMostBoxes));
    }
    value.clear();
    for (const toml::node& each : *boxes) {
      const toml::array* corners = each.as_array();
      if (corners == nullptr || corners->size() != 2) return refuse_with_range(key, each, kForm);
      Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = first;
      read_vector(key, *corners->get(0), first);
      read_vector(key, *corners->get(1), second);
      value.push_back({first.cwiseMin(second), first.cwiseMax(second)});
      if ((value.back().low.array() == value.back().high.array()).any()) {
        return refuse(each, full_name(key),
                      "has a box without inside: its corners share a coordinate");
      }
    }
  }

  template <class Enum>
  void read_choice(const Key& key, const toml::node& node, Enum& value) {
    std::string accepted;
    for (const auto& [name, candidate] : kNames<Enum>) {
      if (node.is_string() && **node.as_string() == name) {
        value = candidate;
        return;
      }
      accepted += fmt::format("{}\"{}\"", accepted.empty() ? "" : ", ", name);
    }
    refuse(node, full_name(key), "must be one of " + accepted);
  }

  const toml::table& root_;
  std::string origin_;
  Configuration& configuration_;
  std::set<std::string> known_;
  std::map<std::string, std::string_view> unread_;  // keys, with the condition that they lack
  std::optional<Error> error_;
};

/// A key stands on one line, so this also bounds how long keys are and how deep `a.b.c = 1` goes:
/// a table is destroyed by recursion, and each level takes stack.
std::optional<Error> too_long_line(std::string_view toml, const std::string& origin) {
  constexpr std::size_t kLongestLine = 1000;
  for (int line = 1; !toml.empty(); ++line) {
    const std::size_t length = std::min(toml.find('\n'), toml.size());
    if (length > kLongestLine) {
      return Error{fmt::format("{}:{}: the line has {} characters, {} are the most", origin, line,
                               length, kLongestLine)};
    }
    toml.remove_prefix(std::min(length + 1, toml.size()));
  }
  return std::nullopt;
}

/// Reads one file's text over the configuration.
std::optional<Error> read_over(std::string_view toml, const std::string& origin,
                               Configuration& configuration) {
  if (auto mistake = too_long_line(toml, origin)) return mistake;
  try {
    const toml::table root = toml::parse(toml, origin);
    Reader reader(root, origin, configuration);
    for_every_key(configuration.settings, reader);
    reader.refuse_unknown(root, "");
    return reader.error();
  } catch (const toml::parse_error& error) {
    return Error{fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description())};
  }
}

std::optional<Error> read_over(const std::filesystem::path& file, Configuration& configuration) {
  constexpr std::uintmax_t kLargestFile = 1 << 20;
  const auto text = read_file(file, kLargestFile);
  if (!text) return text.error();
  return read_over(*text, file.string(), configuration);
}

/// A key that one file sets and another one's choice of a method leaves unread.
std::optional<Error> unread_key(const Configuration& configuration) {
  std::map<std::string, std::string_view> live;  // with their methods
  for_each_key(configuration.settings,
               [&](const Key& key, const auto&) { live.emplace(full_name(key), key.method); });
  for (const auto& [name, source] : configuration.sources) {
    if (source.is_default()) continue;
    const auto key = live.find(name);
    if (key != live.end() && key->second == source.method) continue;
    return Error{fmt::format("{}: {} was set for {}, and another file sets another one",
                             source.text(), name,
                             source.method.empty() ? "another method" : source.method)};
  }
  return std::nullopt;
}

/// What only all files together can have wrong.
/// @param origin stands for a place that no file sets
std::optional<Error> mistake_of(const Configuration& configuration, const std::string& origin) {
  const auto at = [&](const std::vector<std::string>& keys) {
    for (const std::string& key : keys) {
      const Source source = configuration.source_of(key);
      if (!source.is_default()) return source.text();
    }
    return origin;
  };
  // The default is that of one wheel's counts and right for no DBC file.
  if (!configuration.settings.encoder.dbc.empty() &&
      configuration.source_of("encoder.scale").is_default()) {
    return Error{at({"encoder.dbc"}) +
                 ": encoder.dbc needs encoder.scale beside it, metres (or m/s) per unit of the "
                 "signal: 0.277778 for km/h"};
  }
  if (auto unread = unread_key(configuration)) return unread;
  const auto found = contradiction(configuration.settings);
  if (!found) return std::nullopt;
  return Error{at(found->keys) + ": " + found->reason};
}

/// Reads the profiles that lie beside the configuration file, else those shipped. What they say is
/// a default where it is that of the program.
std::optional<Error> read_profiles(const std::filesystem::path& config_file,
                                   Configuration& configuration) {
  for (const std::string_view name : kProfiles) {
    const auto profile = find_file(std::string(name), config_file);
    if (!profile) continue;
    if (auto mistake = read_over(*profile, configuration)) return mistake;
  }
  const auto defaults = toml_values(Settings()), values = toml_values(configuration.settings);
  for (auto& [name, source] : configuration.sources) {
    const auto by_default = defaults.find(name), value = values.find(name);
    source.says_default = by_default != defaults.end() && value != values.end() &&
                          by_default->second == value->second;
  }
  return std::nullopt;
}

std::vector<std::filesystem::path> drop_ins(std::filesystem::path file) {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry :
       std::filesystem::directory_iterator(file.replace_extension(".d"), none)) {
    if (entry.path().extension() == ".toml") found.push_back(entry.path());
  }
  std::ranges::sort(found);
  return found;
}

/// An error for a file that a key names and that is not there; those of the defaults come with
/// Scree.
std::optional<Error> missing_file(const Configuration& configuration,
                                  const std::filesystem::path& config_file) {
  for (const auto& [key, name] : named_files(configuration.settings)) {
    const Source source = configuration.source_of(key);
    if (source.is_default() || name.empty()) continue;
    if (const auto found = find_file(name, config_file); !found) {
      return Error{fmt::format("{}: {}: {}", source.text(), key, found.error().message)};
    }
  }
  return std::nullopt;
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

Result<Configuration> read_configuration(const std::filesystem::path& file) {
  Configuration configuration;
  auto mistake = read_profiles(file, configuration);
  if (!mistake) mistake = read_over(file, configuration);
  for (const std::filesystem::path& drop_in : drop_ins(file)) {
    if (!mistake) mistake = read_over(drop_in, configuration);
  }
  if (!mistake) mistake = mistake_of(configuration, file.string());
  if (!mistake) mistake = missing_file(configuration, file);
  if (mistake) return tl::make_unexpected(*mistake);
  return configuration;
}

Result<Settings> load_settings(const std::filesystem::path& file) {
  auto configuration = read_configuration(file);
  if (!configuration) return tl::make_unexpected(configuration.error());
  return configuration->settings;
}

Result<Settings> parse_settings(std::string_view toml, const std::string& origin) {
  Configuration configuration;
  auto mistake = read_over(toml, origin, configuration);
  if (!mistake) mistake = mistake_of(configuration, origin);
  if (mistake) return tl::make_unexpected(*mistake);
  return configuration.settings;
}

}  // namespace scree
