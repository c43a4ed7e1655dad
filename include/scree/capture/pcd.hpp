#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "scree/core/point_cloud.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// The points of a PCD file, and where they were seen from as its VIEWPOINT line says. The file's
/// origin stands there, too, where nobody knew.
struct PcdCloud : PointCloud {
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();  ///< metres, the points' frame
  /// What was taken off the file's coordinates, viewpoint and points, metres: a place in the cloud
  /// where that lies far from the file's origin, else zero.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};

/// Whether a file begins as a PCD file does, whatever its name. False where it cannot be read.
bool is_pcd(const std::filesystem::path& file);

/// Reads a PCD file (0.7; ascii, binary or binary_compressed) into a cloud of its size. x, y and z
/// may be float or double; reflectivity is the field intensity, i or reflectivity of any number
/// type, as it is, and 0 where there is none. Points that are NaN or infinite are kept. Any bytes
/// are safe: the error is one sentence, and the file's size bounds the memory that is taken.
Result<PcdCloud> read_pcd(const std::filesystem::path& file);

/// Writes x y z intensity, binary. An error names the file; on a full disk a part of it is left.
Result<void> write_pcd(const std::filesystem::path& file, const PointView& points);

}  // namespace scree
