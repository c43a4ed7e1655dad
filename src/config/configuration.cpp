#include "scree/config/configuration.hpp"

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <set>
#include <sstream>
#include <vector>
#define TOML_EXCEPTIONS 1
#include <spdlog/fmt/fmt.h>
#include <toml++/toml.h>

#include "scree/config/keys.hpp"
#include "scree/config/near_names.hpp"

namespace scree {
namespace {

/// Reads one value at a time; keeps the first mistake.
class Reader {
public:
  Reader(const toml::table& root, std::string origin, Configuration& configuration)
      : root_(root), origin_(std::move(origin)), configuration_(configuration) {}

  template <class T>
  void operator()(const Key& key, T& value) {
    const std::string name = full_name(key);
    known_.insert(name);
    const auto node = root_.at_path(name);
    if (!node || error_) return;
    configuration_.sources[name] = {origin_, node.node()->source().begin.line};
    read(key, *node.node(), value);
  }

  /// Names the first key of the file that no setting has.
  void refuse_unknown(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string name =
          prefix.empty() ? std::string(key.str()) : prefix + "." + key.str().data();
      const auto longer = known_.lower_bound(name + ".");
      const bool is_table = longer != known_.end() && longer->starts_with(name + ".");
      if (is_table && node.is_table()) {
        refuse_unknown(*node.as_table(), name);
      } else if (is_table) {
        refuse(node, name, "is a table");
      } else if (!known_.contains(name)) {
        refuse(node, name, "is not a setting; the nearest is " + nearest(name, node.is_table()));
      }
    }
  }

  const std::optional<Error>& error() const { return error_; }

private:
  std::string nearest(std::string_view wanted, bool is_table) const {
    std::vector<std::string_view> names;
    for (const std::string& name : known_) {
      const std::string_view table = std::string_view(name).substr(0, name.rfind('.'));
      names.push_back(is_table ? table : name);
    }
    return near_names(wanted, std::move(names), 1);
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
  std::optional<Error> error_;
};

/// Of two or more keys that do not go together.
struct Contradiction {
  std::vector<std::string> keys;
  std::string reason;
};

std::optional<Contradiction> contradiction(const DetectSettings& detect, std::string_view table) {
  const auto of = [&](std::string_view key) { return fmt::format("{}.{}", table, key); };
  const auto both = [&](std::string_view first, std::string_view relation,
                        std::string_view second) {
    return Contradiction{{of(first), of(second)},
                         fmt::format("{} {} {}", of(first), relation, of(second))};
  };
  if (detect.ground_inner >= detect.ground_outer) {
    return both("ground_inner", "must be below", "ground_outer");
  }
  if (detect.max_edge_points > detect.max_points) {
    return both("max_edge_points", "must not be above", "max_points");
  }
  if (detect.cluster_method == ClusterMethod::regions && !detect.uses_surface()) {
    return both("cluster_method", "= \"regions\" needs the value \"surface\" of", "ground");
  }
  return std::nullopt;
}

std::optional<Contradiction> contradiction(const Settings& settings) {
  if (settings.lidar.min_range >= settings.lidar.max_range) {
    return Contradiction{{"lidar.min_range", "lidar.max_range"},
                         "lidar.min_range must be below lidar.max_range"};
  }
  if (settings.lidar.port == settings.lidar.position_port) {
    return Contradiction{{"lidar.port", "lidar.position_port"},
                         "lidar.port and lidar.position_port must differ"};
  }
  const EncoderSettings& encoder = settings.encoder;
  constexpr int kLargestFrame = 64;
  if (encoder.frame_bytes() > kLargestFrame) {
    return Contradiction{
        {"encoder.start_bit", "encoder.length"},
        "encoder.start_bit and encoder.length reach beyond the 64 bytes of the longest frame"};
  }
  if (encoder.scale == 0) return Contradiction{{"encoder.scale"}, "encoder.scale must not be 0"};
  if (encoder.dbc.empty() != encoder.signal.empty()) {
    return Contradiction{{"encoder.dbc", "encoder.signal"},
                         "encoder.dbc and encoder.signal belong together, one of them is empty"};
  }
  if (settings.track.disappear > settings.track.appear) {
    return Contradiction{{"track.disappear", "track.appear"},
                         "track.disappear must not be above track.appear"};
  }
  auto found = contradiction(settings.detect_cloud, "detect.cloud");
  if (!found) found = contradiction(settings.detect_map, "detect.map");
  if (!found) found = contradiction(settings.detect_sweep, "detect.sweep");
  return found;
}

/// Reads one file's text over the configuration.
std::optional<Error> read_over(std::string_view toml, const std::string& origin,
                               Configuration& configuration) {
  try {
    const toml::table root = toml::parse(toml, origin);
    Reader reader(root, origin, configuration);
    for_each_key(configuration.settings, reader);
    reader.refuse_unknown(root, "");
    return reader.error();
  } catch (const toml::parse_error& error) {
    return Error{fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description())};
  }
}

std::optional<Error> read_over(const std::filesystem::path& file, Configuration& configuration) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    return Error{fmt::format("cannot read the configuration file {}", file.string())};
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return read_over(text.str(), file.string(), configuration);
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
  const auto found = contradiction(configuration.settings);
  if (!found) return std::nullopt;
  return Error{at(found->keys) + ": " + found->reason};
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

/// Of the files that keys name; those of the defaults come with Scree.
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
  return is_default() ? "default" : fmt::format("{}:{}", file, line);
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
  auto mistake = read_over(file, configuration);
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
