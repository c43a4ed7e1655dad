#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/time_span.hpp"
#include "read/host_steps.hpp"

namespace scree::cli {

/// What a capture's folder holds beside the lidar's packets: the members imu, encoder and truth,
/// each null where there is none. A fault of one stands in it as `fault`.
/// @param steps taken out of all times
/// @param lidar when its packets came
nlohmann::ordered_json describe_rest(const std::filesystem::path& capture,
                                     const std::filesystem::path& config, const HostSteps& steps,
                                     const TimeSpan& lidar);
/// The same as rows of info's table.
void print_rest(const nlohmann::ordered_json& info);

}  // namespace scree::cli
