#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace scree::cli {

/// What a capture's folder holds beside the lidar's packets: the members imu, encoder and truth,
/// each null where there is none. A fault of one stands in it as `fault`.
nlohmann::ordered_json describe_rest(const std::filesystem::path& capture,
                                     const std::filesystem::path& config);
/// The same as rows of info's table.
void print_rest(const nlohmann::ordered_json& info);

}  // namespace scree::cli
