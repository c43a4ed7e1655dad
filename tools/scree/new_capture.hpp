#pragma once

#include <filesystem>

#include "scree/config/configuration.hpp"

namespace scree::cli {

/// Copies a robot's configuration into a capture's folder, as its scree.toml (its drop-ins with
/// it), and beside it the files that it names (the DBC file, networks), so that they are found from
/// there; what is shipped with Scree is found anyway. Throws Failure.
void keep_config(const std::filesystem::path& config, const Configuration& configuration,
                 const std::filesystem::path& folder);

}  // namespace scree::cli
