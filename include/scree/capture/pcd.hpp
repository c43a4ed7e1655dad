#pragma once

#include <filesystem>

#include "scree/core/point_cloud.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// Reads a PCD file (0.7; ascii, binary or binary_compressed) into a cloud of its size. x, y and z
/// may be float or double; reflectivity is the field intensity, i or reflectivity of any number
/// type, as it is, and 0 where there is none. Points that are NaN or infinite are kept. Any bytes
/// are safe: the error is one sentence, and the file's size bounds the memory that is taken.
Result<PointCloud> read_pcd(const std::filesystem::path& file);

/// Writes x y z intensity, binary.
Result<void> write_pcd(const std::filesystem::path& file, const PointView& points);

}  // namespace scree
