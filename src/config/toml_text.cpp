#include <spdlog/fmt/fmt.h>

#include "scree/config/configuration.hpp"
#include "scree/config/keys.hpp"
#include "scree/config/reload.hpp"

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

std::string default_settings_toml() {
  std::string text = fmt::format(
      "# Scree's configuration: every key with its default. A key left out keeps its default.\n"
      "# Drop-ins, scree.d/*.toml beside this file, go over it in the order of their names.\n"
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

std::string effective_toml(const Configuration& configuration, bool only_set) {
  constexpr std::size_t kColumn = 40;  // of the remarks
  std::string text;
  std::string_view table;
  for_each_key(configuration.settings, [&](const Key& key, const auto& value) {
    const Source source = configuration.source_of(full_name(key));
    if (only_set && source.is_default()) return;
    if (key.table != table) {
      text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", key.table);
      table = key.table;
    }
    text += fmt::format("{:<{}}  # {}\n", fmt::format("{} = {}", key.name, toml_value(value)),
                        kColumn, source.text());
  });
  return text;
}

}  // namespace scree
