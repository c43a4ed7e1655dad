#include "scree/config/settings.hpp"

#include <set>
#include <sstream>
#define TOML_EXCEPTIONS 1
#include <spdlog/fmt/fmt.h>
#include <toml++/toml.h>

#include <fstream>
#include <vector>

#include "scree/config/keys.hpp"
#include "scree/config/reload.hpp"

namespace scree {

// A ring of a single sweep is dense and the next ring far off: the kernel reaches from ring to
// ring, weighs the nearest points most, and what is steep is too little to be thinned further.
DetectSettings DetectSettings::for_cloud() {
  DetectSettings detect;
  detect.ground = GroundReference::surface;
  detect.candidates = Candidates::bodies;
  detect.suppression = false;
  detect.cluster_method = ClusterMethod::euclidean;
  detect.cluster_tolerance = 0.20;
  detect.min_cluster_size = 4;
  detect.network = "network_cloud.txt";
  return detect;
}

DetectSettings DetectSettings::for_map() {
  DetectSettings detect = for_cloud();
  detect.max_points = MapSettings().max_voxels;
  detect.max_edge_points = 1 << 17;
  detect.max_obstacles = 512;
  detect.voxel_grid = false;
  detect.ground_trend = 2;
  detect.cluster_tolerance = 0.30;
  detect.network = "network_map.txt";
  detect.min_confidence = 0.05;
  return detect;
}

DetectSettings DetectSettings::for_sweep() {
  DetectSettings detect;
  detect.max_points = 1 << 17;
  detect.max_edge_points = 1 << 16;
  detect.leaf_size = 0.05;
  detect.kernel_spacing = 0.20;
  detect.kernel_radius = 0.60;
  detect.kernel_bandwidth = 0.20;
  detect.edge_threshold = 0.25;
  detect.suppression = false;
  detect.voxel_size = 0.10;
  detect.seed_distance = 0.30;
  detect.min_block_points = 3;
  detect.cluster_tolerance = 0.50;
  detect.min_cluster_size = 2;
  detect.ground_outer = 1.5;
  detect.network = "network_sweep.txt";
  return detect;
}

namespace {

std::string full_name(const Key& key) {
  return fmt::format("{}.{}", key.table, key.name);
}

/// Reads one value at a time; keeps the first mistake.
class Reader {
public:
  Reader(const toml::table& root, std::string origin) : root_(root), origin_(std::move(origin)) {}

  template <class T>
  void operator()(const Key& key, T& value) {
    const std::string name = full_name(key);
    known_.insert(name);
    const auto node = root_.at_path(name);
    if (!node || error_) return;
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
        refuse(node, name, "is not a setting");
      }
    }
  }

  const std::optional<Error>& error() const { return error_; }

private:
  void refuse(const toml::node& node, std::string_view name, std::string_view reason) {
    if (error_) return;
    error_ = Error{fmt::format("{}:{}: {} {}", origin_, node.source().begin.line, name, reason)};
  }

  bool in_range(const Key& key, const toml::node& node, double value) {
    if (value >= key.low && value <= key.high) return true;
    refuse(node, full_name(key),
           fmt::format("= {} is out of range, accepted is {} to {}{}{}", value, key.low, key.high,
                       key.unit.empty() ? "" : " ", key.unit));
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
      if (!node.is_integer()) return refuse(node, full_name(key), "must be a whole number");
      const std::int64_t read = **node.as_integer();
      if (in_range(key, node, static_cast<double>(read))) value = static_cast<T>(read);
    } else if constexpr (std::is_same_v<T, double>) {
      if (!node.is_number()) return refuse(node, full_name(key), "must be a number");
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
      return refuse(node, full_name(key), "must be three numbers, [x, y, z]");
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const toml::node& element = *array->get(i);
      if (!element.is_number()) return refuse(element, full_name(key), "must be three numbers");
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
  std::set<std::string> known_;
  std::optional<Error> error_;
};

std::optional<std::string> contradiction(const Settings& settings) {
  if (settings.lidar.min_range >= settings.lidar.max_range) {
    return "lidar.min_range must be below lidar.max_range";
  }
  const EncoderSettings& encoder = settings.encoder;
  constexpr int kLargestFrame = 64;
  if (encoder.frame_bytes() > kLargestFrame) {
    return "encoder.start_bit and encoder.length reach beyond the 64 bytes of the longest frame";
  }
  if (encoder.scale == 0) return "encoder.scale must not be 0";
  if (encoder.dbc.empty() != encoder.signal.empty()) {
    return "encoder.dbc and encoder.signal belong together, one of them is empty";
  }
  if (settings.track.disappear > settings.track.appear) {
    return "track.disappear must not be above track.appear";
  }
  const std::pair<const char*, const DetectSettings*> sets[] = {
      {"detect.cloud", &settings.detect_cloud},
      {"detect.map", &settings.detect_map},
      {"detect.sweep", &settings.detect_sweep}};
  for (const auto& [table, detect] : sets) {
    if (detect->ground_inner >= detect->ground_outer) {
      return fmt::format("{0}.ground_inner must be below {0}.ground_outer", table);
    }
    if (detect->max_edge_points > detect->max_points) {
      return fmt::format("{0}.max_edge_points must not be above {0}.max_points", table);
    }
  }
  return std::nullopt;
}

std::string toml_value(bool value) {
  return value ? "true" : "false";
}
std::string toml_value(int value) {
  return std::to_string(value);
}
std::string toml_value(std::int64_t value) {
  return fmt::format("0x{:X}", value);
}
std::string toml_value(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string toml_value(const std::string& value) {
  return "\"" + value + "\"";
}
std::string toml_value(const Eigen::Vector3d& value) {
  return fmt::format("[{}, {}, {}]", toml_value(value.x()), toml_value(value.y()),
                     toml_value(value.z()));
}
template <class Enum>
requires std::is_enum_v<Enum> std::string toml_value(Enum value) {
  return fmt::format("\"{}\"", name_of(value));
}

template <class T>
std::string accepted_values(const Key& key, const T&) {
  std::string accepted(key.unit);
  if constexpr (std::is_enum_v<T>) {
    for (const auto& [name, value] : kNames<T>) {
      accepted += fmt::format("{}{}", accepted.empty() ? "" : " | ", name);
    }
  } else if (key.low < key.high) {
    accepted += fmt::format("{}{} to {}", accepted.empty() ? "" : ", ", key.low, key.high);
  }
  return accepted.empty() ? accepted : "  (" + accepted + ")";
}

}  // namespace

Result<Settings> parse_settings(std::string_view toml, const std::string& origin) {
  Settings settings;
  try {
    const toml::table root = toml::parse(toml, origin);
    Reader reader(root, origin);
    for_each_key(settings, reader);
    reader.refuse_unknown(root, "");
    // The default is that of one wheel's counts and right for no DBC file.
    if (!settings.encoder.dbc.empty() && !root.at_path("encoder.scale")) {
      return fail(origin +
                  ": encoder.dbc needs encoder.scale beside it, metres (or m/s) per unit of the "
                  "signal: 0.277778 for km/h");
    }
    if (reader.error()) return tl::make_unexpected(*reader.error());
  } catch (const toml::parse_error& error) {
    return fail(fmt::format("{}:{}: {}", origin, error.source().begin.line, error.description()));
  }
  if (const auto reason = contradiction(settings)) return fail(origin + ": " + *reason);
  return settings;
}

Result<Settings> load_settings(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    return fail(fmt::format("cannot read the configuration file {}", file.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return parse_settings(text.str(), file.string());
}

std::string default_settings_toml() {
  std::string text = fmt::format(
      "# Scree's configuration: every key with its default. A key left out keeps its default.\n"
      "# `systemctl reload screed` takes over {}; the other keys need a restart.\n",
      kReloadableKeys);
  std::string_view table;
  const Settings defaults;
  for_each_key(defaults, [&](const Key& key, const auto& value) {
    if (key.table != table) text += fmt::format("\n[{}]\n", key.table);
    table = key.table;
    text += fmt::format("# {}{}\n{} = {}\n", key.meaning, accepted_values(key, value), key.name,
                        toml_value(value));
  });
  return text;
}

Result<std::filesystem::path> find_file(const std::string& name,
                                        const std::filesystem::path& config_folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path shipped = program.parent_path().parent_path() / "share" / "scree";
  for (const fs::path& folder : {config_folder, shipped}) {
    const fs::path candidate = folder / name;
    if (fs::is_regular_file(candidate, ignored)) return candidate;
  }
  return fail(
      fmt::format("cannot find {} beside the configuration file or in {}", name, shipped.string()));
}

}  // namespace scree
