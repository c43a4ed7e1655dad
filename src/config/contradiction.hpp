#pragma once

#include <string>
#include <vector>

#include "scree/config/settings.hpp"

namespace scree {

/// Keys that do not go together, and why.
struct Contradiction {
  std::vector<std::string> keys;
  std::string reason;
};

/// Those that the settings have.
std::vector<Contradiction> contradictions(const Settings& settings);

}  // namespace scree
