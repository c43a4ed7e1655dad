#pragma once

#include <filesystem>

#include "scree/config/settings.hpp"

namespace scree::cli {

/// Copies a robot's configuration into a capture's folder, as its scree.toml, and beside it the
/// files that it names (the DBC file, networks), so that they are found from there; what is shipped
/// with Scree is found anyway. Throws Failure.
void keep_config(const std::filesystem::path& config, const Settings& settings,
                 const std::filesystem::path& folder);

}  // namespace scree::cli
