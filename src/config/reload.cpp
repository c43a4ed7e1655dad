#include "scree/config/reload.hpp"

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
  std::vector<const void*> wanted_values;
  for_each_key(wanted, [&](const Key&, const auto& value) { wanted_values.push_back(&value); });
  std::size_t next = 0;
  for_each_key(result.settings, [&]<class Value>(const Key& key, Value& value) {
    // The keys come in the same order, so this is the same key's.
    const Value& wanted_value = *static_cast<const Value*>(wanted_values[next++]);
    if (value == wanted_value) return;
    const bool can_change = is_reloadable(key);
    (can_change ? result.applied : result.refused).push_back(full_name(key));
    if (can_change) value = wanted_value;
  });
  return result;
}

}  // namespace scree
