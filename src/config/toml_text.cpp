#include <spdlog/fmt/fmt.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "scree/config/configuration.hpp"
#include "scree/config/keys.hpp"
#include "scree/config/reload.hpp"
#include "toml_string.hpp"

namespace scree {
namespace {

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
  return toml_string(value);
}
std::string toml_value(const Eigen::Vector3d& value) {
  return fmt::format("[{}, {}, {}]", toml_value(value.x()), toml_value(value.y()),
                     toml_value(value.z()));
}
std::string toml_value(const std::vector<BodyBox>& value) {
  std::string text;
  for (const BodyBox& box : value) {
    text += fmt::format("{}[{}, {}]", text.empty() ? "" : ", ", toml_value(box.low),
                        toml_value(box.high));
  }
  return "[" + text + "]";
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

std::string_view head_of(std::string_view file) {
  if (file == "cloud.toml") {
    return "# Profile for reconstructed clouds: scree detect CLOUD.pcd\n";
  }
  if (file == "map.toml") {
    return "# Profile for driving: the map that grows, detection in it, and tracks.\n";
  }
  if (file == "sweep.toml") {
    return "# Profile for single sweeps, where nothing tells how the robot moves.\n";
  }
  return {};
}

/// A remark ends with its line, so a file's name must not break it.
std::string remark(const Source& source) {
  std::string text = source.text();
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return text;
}

bool is_shown(const Key& key, const Source& source, Shown shown) {
  if (shown == Shown::all || !source.is_default()) return true;
  return shown == Shown::owners && file_of(key) == kOwnersFile;
}

}  // namespace

std::string toml_string(std::string_view text) {
  const toml::value<std::string> value{std::string(text)};
  std::ostringstream written;
  written << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};
  return written.str();
}

std::string_view file_of(const Key& key) {
  if (key.table == "detect.cloud") return "cloud.toml";
  if (key.table == "detect.sweep") return "sweep.toml";
  const bool is_owners =
      (key.table == "map" && key.name == "wait") ||
      (key.table == "track" && (key.name == "reach" || key.name == "least_height"));
  const bool is_driving =
      key.table == "detect.map" || ((key.table == "map" || key.table == "track") && !is_owners);
  return is_driving ? "map.toml" : kOwnersFile;
}

std::string default_toml(std::string_view file) {
  std::string text(head_of(file));
  if (file == kOwnersFile) {
    text = fmt::format(
        "# What a robot's owner sets. Each key stands here with its default, as a remark: take its "
        "# away\n"
        "# to set it.\n"
        "# How obstacles are found is tuned in the profiles cloud.toml, map.toml and sweep.toml:\n"
        "# /usr/share/scree has them. A copy beside this file is read instead, and each of their\n"
        "# keys can stand here too. `scree config --all` shows every key and where it is set.\n"
        "# Drop-ins, scree.d/*.toml beside this file, go over it in the order of their names.\n"
        "# `systemctl reload screed` takes over {}; the other keys need a restart.\n",
        kReloadableKeys);
  }
  std::string_view table;
  const Settings defaults;
  for_each_key(defaults, [&](const Key& key, const auto& value) {
    if (file_of(key) != file) return;
    if (key.table != table) text += fmt::format("\n[{}]\n", key.table);
    table = key.table;
    // What an owner leaves as it is comes from the program: an update then brings new defaults.
    text += fmt::format("# {}{}\n{}{} = {}\n", key.meaning, accepted_values(key, value),
                        file == kOwnersFile ? "#" : "", key.name, toml_value(value));
  });
  return text;
}

std::string effective_toml(const Configuration& configuration, Shown shown) {
  constexpr std::size_t kColumn = 40;  // of the remarks
  std::string text;
  std::string_view table;
  for_each_key(configuration.settings, [&](const Key& key, const auto& value) {
    const Source source = configuration.source_of(full_name(key));
    if (!is_shown(key, source, shown)) return;
    if (key.table != table) {
      text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", key.table);
      table = key.table;
    }
    text += fmt::format("{:<{}}  # {}\n", fmt::format("{} = {}", key.name, toml_value(value)),
                        kColumn, remark(source));
  });
  return text;
}

std::map<std::string, std::string, std::less<>> toml_values(const Settings& settings) {
  std::map<std::string, std::string, std::less<>> values;
  for_each_key(settings, [&](const Key& key, const auto& value) {
    values.emplace(full_name(key), toml_value(value));
  });
  return values;
}

}  // namespace scree
