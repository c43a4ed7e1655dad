#pragma once

#include <cstdint>
#include <span>

#include "scree/detect/beam_grid.hpp"
#include "scree/detect/clusters.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree {

/// The context features of clusters, those beyond the paper's five: what lies in and around a
/// cluster on the raster of the ground's surface.
class ClusterContext {
public:
  explicit ClusterContext(std::size_t max_cells)
      : sides_(max_cells),
        visited_(max_cells),
        lowest_(max_cells),
        highest_(max_cells),
        steepest_(max_cells),
        cells_(max_cells),
        values_(max_cells),
        ground_seen_(4 * max_cells) {}

  /// Notes where the ground itself was seen, and in which cells something stands above it or lies
  /// below it.
  void build(PointView cloud, const CandidatePoints& edges, const GroundSurface& surface);

  /// Sets the features from box_length on.
  /// @param members of the cluster among the points given to build()
  void measure(Cluster& cluster, std::span<const std::uint32_t> members,
               const CandidatePoints& edges, const GroundSurface& surface, const BeamGrid& beams);

private:
  enum Side : std::uint8_t { above = 1, below = 2 };

  std::size_t quarter_at(float x, float y, const GroundSurface& surface) const;
  bool is_amid_ground(float x, float y, const GroundSurface& surface) const;
  void measure_points(Features& features, std::span<const std::uint32_t> members,
                      const CandidatePoints& edges, const GroundSurface& surface) const;
  void collect_cells(Features& features, std::span<const std::uint32_t> members,
                     const CandidatePoints& edges, const GroundSurface& surface);
  static void measure_around(Features& features, const OrientedBox& box,
                             const GroundSurface& surface, const BeamGrid& beams);
  void measure_solidity(Features& features, const BeamGrid& beams);
  void measure_scatter(Features& features, const BeamGrid& beams);
  void measure_edge(Features& features, const GroundSurface& surface);

  FixedVector<std::uint8_t> sides_;
  FixedVector<std::uint32_t> visited_;     // number of the last cluster that counted the cell
  FixedVector<float> lowest_, highest_;    // heights of that cluster in it
  FixedVector<float> steepest_;            // its steepest slope in it
  FixedVector<std::uint32_t> cells_;       // those of that cluster
  FixedVector<float> values_;              // scratch: a value of each of these
  FixedVector<std::uint8_t> ground_seen_;  // in each quarter of a cell, row by row
  std::uint32_t number_ = 0;
};

}  // namespace scree
