#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/candidate_points.hpp"

namespace scree {

/// The points of a cloud by their azimuth, as one place saw them. Tells whether a cluster of a
/// single sweep, where the ground is known in rings only, can be a hole: the beams that reached it
/// passed the level of the ground behind ground that was seen, and before anything else that was.
class BeamSectors {
public:
  explicit BeamSectors(std::size_t max_points) : sorted_(max_points) {}

  void build(PointView points, const Eigen::Vector3f& origin);

  /// What says that points below the ground are a hole; none: nothing does.
  /// @param ground z of the ground around them, metres
  Evidence of(std::span<const std::uint32_t> members, const PointCloud& points, float ground) const;

private:
  static constexpr std::size_t kSectors = 360;
  struct Entry {
    float range, z;  ///< metres in the plane, metres
  };

  std::size_t sector_of(float x, float y) const;
  bool goes_into(float x, float y, float z, float ground) const;

  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  std::array<std::uint32_t, kSectors + 1> begin_{};
  FixedVector<Entry> sorted_;  // by sector
};

}  // namespace scree
