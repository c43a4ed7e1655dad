#pragma once

#include <array>
#include <cstddef>

namespace scree {

/// What the network is told of a cluster. First F1-F5 of the paper (section 3.2): heights in metres
/// above the ground, and counts of points. The others are ours and need the ground's surface; they
/// are 0 without it. Where nothing is known of beams all is solid. Scatter: see RangeScatter.
enum Feature : std::size_t {
  mean_height,
  max_height,
  min_height,
  acute_count,
  obtuse_count,
  box_length,     ///< metres
  box_width,      ///< metres
  steepness,      ///< mean slope of its points, metres per metre
  rim_share,      ///< of its cells: next to something on the other side of the ground
  unseen_share,   ///< of the cells of its box: without a point
  through_share,  ///< of its points: with ground seen on all sides of it; tufts let light through
  ground_share,   ///< of the cells up to 0.3 m around its box: known to be ground
  cell_points,    ///< mean number of points in its cells
  cell_spread,    ///< mean height between the lowest and the highest point of its cells, metres
  roughness,      ///< of the ground up to 0.6 m around: mean distance of its cells from the surface
  solid_share,    ///< of its cells: that stop at least 70 % of the beams
  top_solidity,   ///< of the beams to its cells that reach half its height: the share that ended
  core_solidity,  ///< upper quartile of BeamGrid::ended_share_around() over its cells
  beam_count,     ///< beams that ended in it
  steepest,       ///< of its cells: upper tenth of the steepest slope in each, metres per metre
  edge_height,    ///< median height or depth of its cells next to seen ground, metres
  edge_share,     ///< of those cells: that reach half its height
  range_scatter,  ///< median over its cells: mean of the beams that ended there, metres
  loose_around,   ///< of the cells up to 0.3 m around its box: with something loose, see BeamGrid
  over_loose,     ///< its highest point above the highest in those, metres; above the ground: none
  least_scatter,  ///< lower quartile of what range_scatter is the median of, metres
  firm_cells,     ///< share of its cells where that is below BeamGrid::kFirmScatter
  firm_beams,     ///< of the beams that ended in it: share in those cells
  solid_beams,    ///< of the same: share that BeamGrid::solid() counts
  solid_core,     ///< most of these in one of its cells
  all_beams,      ///< beams that ended in its cells at any height, so in a hole, too
  all_scatter,    ///< mean over these, metres
  ground_scatter,  ///< the same over those up to 0.6 m around its box: grass hides the ground
  kFeatures
};
inline constexpr std::size_t kPaperFeatures = 5;
/// What the shipped network for clouds takes; the others tell tufts and uneven ground in sparser
/// maps.
inline constexpr std::size_t kCloudFeatures = cell_points;
using Features = std::array<float, kFeatures>;

}  // namespace scree
