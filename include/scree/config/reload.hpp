#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scree/config/settings.hpp"

namespace scree {

/// The keys that a running daemon takes over, in words.
inline constexpr std::string_view kReloadableKeys = "[stop], [track] but its network, and map.wait";

/// A configuration that was read anew, beside the one that runs.
struct Reload {
  Settings settings;                          ///< those that run, with what can change meanwhile
  std::vector<std::string> applied, refused;  ///< names of keys that differ; refused need a restart
};
Reload reload(const Settings& running, const Settings& wanted);

}  // namespace scree
