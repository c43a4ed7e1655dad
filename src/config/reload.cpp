#include "scree/config/reload.hpp"

#include "scree/config/configuration.hpp"
#include "scree/config/keys.hpp"

namespace scree {
namespace {

bool is_reloadable(const Key& key) {
  return key.table == "stop" || (key.table == "track" && key.name != "network") ||
         (key.table == "map" && key.name == "wait");
}

}  // namespace

Reload reload(const Settings& running, const Settings& wanted) {
  Reload result{running, {}, {}};
  const auto values_now = toml_values(running);
  auto values = toml_values(wanted);
  for_each_key(wanted, [&](const Key& key, const auto&) {
    const std::string name = full_name(key);
    const auto now = values_now.find(name);
    if (now != values_now.end() && now->second == values[name]) return;
    (is_reloadable(key) ? result.applied : result.refused).push_back(name);
  });
  result.settings.stop = wanted.stop;
  result.settings.track = wanted.track;
  result.settings.track.network = running.track.network;
  result.settings.map.wait = wanted.map.wait;
  return result;
}

}  // namespace scree
