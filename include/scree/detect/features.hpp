#pragma once

#include <array>
#include <cstddef>

namespace scree {

/// What the network is told of a cluster. First come F1-F5 of the paper (section 3.2): heights in
/// metres above the ground, and counts of points. The others are ours and need the ground's
/// surface; without it they are 0. Cells are those of its raster. Where nothing is known of beams,
/// everything is solid. RangeScatter says what the scatter of a beam is.
enum Feature : std::size_t {
  mean_height,
  max_height,
  min_height,
  acute_count,
  obtuse_count,
  box_length,      ///< metres
  box_width,       ///< metres
  steepness,       ///< mean slope of its points, metres per metre
  rim_share,       ///< share of its cells next to something on the other side of the ground
  unseen_share,    ///< share of the cells in its box that have no point
  through_share,   ///< share of its points with ground seen all around; tufts let light through
  ground_share,    ///< share of the cells up to 0.3 m around its box that are known to be ground
  cell_points,     ///< mean number of points in its cells
  cell_spread,     ///< mean height between the lowest and the highest point of its cells, metres
  roughness,       ///< mean distance of the ground up to 0.6 m around from its surface, metres
  solid_share,     ///< share of its cells that stop at least 70 % of the beams
  top_solidity,    ///< share of the beams that ended, over its cells that reach half its height
  core_solidity,   ///< upper quartile of BeamGrid::ended_share_around() over its cells
  beam_count,      ///< beams that ended in it
  steepest,        ///< upper tenth, over its cells, of the steepest slope in each, metres per metre
  edge_height,     ///< median height or depth of its cells next to seen ground, metres
  edge_share,      ///< share of those cells that reach half its height
  range_scatter,   ///< median, over its cells, of the mean scatter of the beams there, metres
  loose_around,    ///< share of the cells up to 0.3 m around its box that BeamGrid calls loose
  over_loose,      ///< height of its top above the highest of those, or above the ground, metres
  least_scatter,   ///< lower quartile of what range_scatter is the median of, metres
  firm_cells,      ///< share of its cells whose mean scatter is below BeamGrid::kFirmScatter
  firm_beams,      ///< share, of the beams that ended in it, of those in firm cells
  solid_beams,     ///< share, of the beams that ended in it, that BeamGrid::solid() counts
  solid_core,      ///< most of BeamGrid::solid() in one of its cells
  all_beams,       ///< beams that ended in its cells at any height, so in a hole, too
  all_scatter,     ///< mean scatter of these, metres
  ground_scatter,  ///< the same of those up to 0.6 m around its box: grass hides the ground, metres
  kFeatures
};
inline constexpr std::size_t kPaperFeatures = 5;
/// Those that few clouds are enough to learn from; the others tell tufts and uneven ground.
inline constexpr std::size_t kCloudFeatures = cell_points;
using Features = std::array<float, kFeatures>;

}  // namespace scree
