#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>
#define TOML_EXCEPTIONS 1
#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <toml++/toml.h>

#include "mistakes.hpp"
#include "scree/config/configuration.hpp"
#include "scree/config/keys.hpp"
#include "scree/config/near_names.hpp"
#include "scree/config/removed_keys.hpp"
#include "toml_string.hpp"

namespace scree {

/// In quotes where it is no bare key: then "lidar.port" is not taken for port in lidar.
inline std::string part_of_name(std::string_view key) {
  const bool is_bare = !key.empty() && std::ranges::all_of(key, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return is_bare ? std::string(key) : toml_string(key);
}

/// Reads one value at a time over a configuration.
class KeyReader {
public:
  KeyReader(const toml::table& root, std::string origin, Configuration& configuration,
            Mistakes& mistakes)
      : root_(root),
        origin_(std::move(origin)),
        configuration_(configuration),
        mistakes_(mistakes) {}

  template <class T>
  void operator()(const Key& key, T& value) {
    const std::string name = full_name(key);
    if (!key.is_live) {
      unread_.emplace(name, key.only_with);
      return;
    }
    known_.insert(name);
    const auto node = root_.at_path(name);
    if (!node) return;
    configuration_.sources[name] = {
        .file = origin_, .line = node.node()->source().begin.line, .method = key.method};
    read(key, *node.node(), value);
  }

  /// Names the keys of the file that no setting has.
  void refuse_unknown(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      if (mistakes_.is_full()) return;
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

private:
  std::string why_not(const std::string& name, bool is_table) const {
    if (const auto unread = unread_.find(name); unread != unread_.end()) {
      return fmt::format("is read only with {}", unread->second);
    }
    if (const auto replacement = replacement_of(name)) return "is gone: " + *replacement;
    std::set<std::string_view> tables;
    for (const std::string& key : known_) {
      tables.insert(std::string_view(key).substr(0, key.rfind('.')));
    }
    const std::vector<std::string_view> names =
        is_table ? std::vector<std::string_view>(tables.begin(), tables.end())
                 : std::vector<std::string_view>(known_.begin(), known_.end());
    const std::string nearest = nearest_name(name, names);
    if (!nearest.empty()) return "is not a setting; the nearest is " + nearest;
    return fmt::format("is not a setting; there are those of {}", fmt::join(tables, ", "));
  }

  void refuse(const toml::node& node, std::string_view name, std::string_view reason) {
    mistakes_.add(origin_, node.source().begin.line, fmt::format("{} {}", name, reason));
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
    const toml::array* boxes = node.as_array();
    if (boxes == nullptr || boxes->size() > kMostBoxes) {
      return refuse(
          node, full_name(key),
          fmt::format("must be up to {} boxes, [[[x, y, z], [x, y, z]], ...]", kMostBoxes));
    }
    value.clear();
    for (const toml::node& box : *boxes) read_box(key, box, value);
  }

  void read_box(const Key& key, const toml::node& node, std::vector<BodyBox>& value) {
    const toml::array* corners = node.as_array();
    if (corners == nullptr || corners->size() != 2) {
      return refuse(node, full_name(key), "must be boxes of two corners, [[x, y, z], [x, y, z]]");
    }
    Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = Eigen::Vector3d::Ones();
    read_vector(key, *corners->get(0), first);
    read_vector(key, *corners->get(1), second);
    if ((first.array() == second.array()).any()) {
      refuse(node, full_name(key), "has a box without inside: its corners share a coordinate");
    }
    value.push_back({first.cwiseMin(second), first.cwiseMax(second)});
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
  Mistakes& mistakes_;
};

}  // namespace scree
