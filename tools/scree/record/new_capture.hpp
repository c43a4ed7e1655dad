#pragma once

#include <filesystem>

#include "common/outputs.hpp"

namespace scree::cli {

/// Makes the folder of a new capture. Throws Failure where it is there and not empty, unless that
/// is to be overwritten: then no file of the capture that it held stays.
/// @param config is yet to be read, and stays
void make_capture_folder(const std::filesystem::path& folder, const Outputs& outputs,
                         const std::filesystem::path& config);

/// Copies a robot's configuration into a capture's folder, as its scree.toml (its drop-ins with
/// it), and beside it the files that it names (the DBC file, networks), so that they are found from
/// there; what is shipped with Scree is found anyway. Throws Failure.
void keep_config(const std::filesystem::path& config, const std::filesystem::path& folder);

}  // namespace scree::cli
