#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>

#include "scree/core/obstacle.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/features.hpp"
#include "scree/detect/oriented_box.hpp"

namespace scree {

/// Points that belong together, and what the network is told of them.
struct Cluster {
  std::uint32_t begin = 0, end = 0;  ///< its points in Clusters::members()
  std::uint32_t size = 0;            ///< super-voxels, or points where there are none
  OrientedBox box;                   ///< around its points
  float lowest = 0, highest = 0;     ///< z of its points, metres
  float ground = 0;                  ///< z of the ground around it, metres
  Features features{};
  Evidence evidence = Evidence::none;  ///< that it is a hole
  bool is_terrace = false;             ///< ground on a higher level
  bool is_sure_hole = false;           ///< whatever the network says
};

/// The clusters of one cloud with their points.
class Clusters {
public:
  /// @param least_size the least `min_size` that will be asked for
  explicit Clusters(std::size_t max_points, std::size_t least_size = 1);

  /// Gathers the points of each label that is borne by at least `min_size` units, and their boxes.
  /// @param labels of each edge point, below `sizes.size()`, or kNoLabel
  /// @param sizes units (super-voxels or points) of each label
  void gather(const CandidatePoints& edges, std::span<const std::uint32_t> labels,
              std::span<const std::uint32_t> sizes, std::uint32_t min_size);

  /// Parts each cluster whose box covers a place into the quarters around that place, those of at
  /// least `min_size` points: nothing stands where the robot does.
  void part_around(const Eigen::Vector2f& place, PointView points, std::uint32_t min_size);

  /// Parts each long cluster above the ground whose box is mostly empty, as that of a wall around a
  /// corner or of a bent step is, into parts of at least `min_size` points.
  void part_bent(const CandidatePoints& points, std::uint32_t min_size);

  std::span<Cluster> all() { return clusters_; }
  std::span<const Cluster> all() const { return clusters_; }
  /// Indices of a cluster's points among the edge points.
  std::span<const std::uint32_t> members(const Cluster& cluster) const {
    return std::span<const std::uint32_t>(members_).subspan(cluster.begin,
                                                            cluster.end - cluster.begin);
  }

private:
  static constexpr std::size_t kMostParts = 4;  // more than a cluster was

  Cluster part(std::uint32_t begin, std::uint32_t end, PointView points,
               std::optional<float> yaw = std::nullopt) const;
  std::uint32_t cut(const Cluster& cluster, PointView points);

  FixedVector<Cluster> clusters_;
  FixedVector<std::uint32_t> members_, place_;
};

/// What a method hands on: clusters, and the points that they are made of. Valid until the method's
/// next call.
struct ClusteredPoints {
  const CandidatePoints& points;
  const Clusters& clusters;
};

/// F1-F5 of the paper (section 3.2, fig. 8), from the points' own heights. The normal n at a
/// point is (slope_x, slope_y, -1), into the ground: its horizontal part points uphill, so the
/// angle to m, the horizontal vector to the axis through the centre of gravity, is acute on a bump
/// and obtuse in a bowl. A right angle counts for neither.
Features measure(const CandidatePoints& edges, std::span<const std::uint32_t> members);

}  // namespace scree
