#pragma once

#include <filesystem>

#include "common/outputs.hpp"

namespace scree::cli {

/// Records the sensors that a configuration names into a new capture, until the time is over
/// (0: never) or the program is asked to end. Says on stderr what is missing. Throws Failure where
/// a port is taken, a file cannot be written, or nothing has come.
void record_sensors(const std::filesystem::path& config, const std::filesystem::path& folder,
                    double seconds, const Outputs& outputs);

}  // namespace scree::cli
