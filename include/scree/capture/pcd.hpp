#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "scree/core/point_cloud.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// The points of a PCD file, and where they were seen from as its VIEWPOINT line says. The origin
/// stands there, too, where nobody knew.
struct PcdCloud : PointCloud {
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();  ///< metres, the points' frame
};

/// Reads a PCD file (0.7; ascii, binary or binary_compressed) into a cloud of its size. x, y and z
/// may be float or double; reflectivity is the field intensity, i or reflectivity of any number
/// type, as it is, and 0 where there is none. Points that are NaN or infinite are kept. Any bytes
/// are safe: the error is one sentence, and the file's size bounds the memory that is taken.
Result<PcdCloud> read_pcd(const std::filesystem::path& file);

/// Writes x y z intensity, binary.
Result<void> write_pcd(const std::filesystem::path& file, const PointView& points);

}  // namespace scree
