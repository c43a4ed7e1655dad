#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree {

/// Euclidean clustering as the paper has it (algorithm 1): from each point not yet taken a group
/// grows by the neighbours that a KD-tree finds within a tolerance. The groups are those of
/// EuclideanClusters. Memory is taken once, here.
class KdTreeClusters {
public:
  explicit KdTreeClusters(std::size_t max_points);
  ~KdTreeClusters();
  KdTreeClusters(KdTreeClusters&&) noexcept;
  KdTreeClusters& operator=(KdTreeClusters&&) noexcept;

  /// @param tolerance metres, inclusive
  /// @pre finite points, no more than max_points of them
  void cluster(PointView points, float tolerance);

  /// Cluster of each point, numbered from 0 in the order of their first points.
  std::span<const std::uint32_t> labels() const { return labels_; }
  /// Points of each cluster.
  std::span<const std::uint32_t> sizes() const { return sizes_; }

private:
  struct TreePoints;
  class Tree;
  std::unique_ptr<Tree> tree_;
  FixedVector<std::uint32_t> labels_, sizes_, queue_;
};

}  // namespace scree
