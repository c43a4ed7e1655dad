#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scree/config/settings.hpp"

namespace scree {

/// Keys that do not go together, and why.
struct Contradiction {
  std::vector<std::string> keys;
  std::string reason;
};

/// The first that the settings have.
std::optional<Contradiction> contradiction(const Settings& settings);

}  // namespace scree
