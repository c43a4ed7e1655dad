#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/beam_count.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree {

/// Counts, on the raster of the ground's surface, the beams that came to what stands above the
/// ground: how many ended there, how many went on, and how much the ranges of the former scatter.
/// A rock stops every beam. Between blades of grass most go on, and the others end as deep in it as
/// they happen to.
class BeamGrid {
public:
  /// Ranges on a rock scatter less than this, metres: by the sensor's noise, which its data sheet
  /// puts at 3 cm at most.
  static constexpr float kFirmScatter = 0.02F;

  explicit BeamGrid(std::size_t max_cells)
      : ended_(max_cells),
        passed_(max_cells),
        scatter_(max_cells),
        ended_share_around_(max_cells),
        solid_(max_cells),
        highest_(max_cells),
        all_ended_(max_cells),
        all_scatter_(max_cells),
        loose_(max_cells),
        seen_(max_cells),
        patch_(max_cells) {}

  /// Counts the beams of the points that stand between two heights above the surface, metres.
  /// @param beams of each point of the cloud; empty where nothing is known of them
  void build(PointView cloud, std::span<const BeamCount> beams, const GroundSurface& surface,
             float lowest, float highest);

  /// Sets is_loose() alone, in half the time: what else the grid has is not to be asked for then.
  void find_loose(PointView cloud, std::span<const BeamCount> beams, const GroundSurface& surface,
                  float lowest, float highest);

  // The arguments are cells of the raster.
  /// Beams that ended on what stands in the cell.
  float ended(std::size_t cell) const { return ended_[cell]; }
  /// Beams that went through what stands in it, and ended farther on.
  float passed(std::size_t cell) const { return passed_[cell]; }
  /// Sum of the scatter of the ranges of those that ended, metres.
  float scatter(std::size_t cell) const { return scatter_[cell]; }
  /// Beams that ended in points which stop at least nine of ten and hardly scatter them.
  float solid(std::size_t cell) const { return solid_[cell]; }
  /// Beams that ended at any height up to the highest, so in holes and on the ground, too.
  float all_ended(std::size_t cell) const { return all_ended_[cell]; }
  /// Sum of the scatter of these, metres.
  float all_scatter(std::size_t cell) const { return all_scatter_[cell]; }
  /// Share of the beams that ended; 1 without any.
  float ended_share(std::size_t cell) const { return share(ended_[cell], passed_[cell]); }
  /// The same share over the cell and those up to two cells away.
  float ended_share_around(std::size_t cell) const { return ended_share_around_[cell]; }
  /// Whether beams ended on what stands in it, and hardly any went on.
  bool stops_all(std::size_t cell) const { return ended_[cell] > 0 && ended_share(cell) >= kAll; }
  /// Height above the surface of the highest point that was counted, metres; 0 without any.
  float highest(std::size_t cell) const { return highest_[cell]; }
  /// Whether the ranges scatter, there and in the cells next to it, as they do among blades. At
  /// least six cells are so together, unless they stand alone.
  bool is_loose(std::size_t cell) const { return loose_[cell] != 0; }
  /// is_loose() of all cells: not 0.
  std::span<const std::uint8_t> loose() const { return {loose_.data(), loose_.size()}; }

  /// One more beam ended than was counted: few beams say little.
  static float share(float ended, float passed) { return (ended + 1) / (ended + passed + 1); }

private:
  static constexpr std::uint8_t kFirm = 0, kLoose = 1;
  /// Voxels at an edge count beams that went past it, too.
  static constexpr float kAll = 0.94F;

  void look_around(std::size_t columns);
  void mark_loose(std::size_t columns);
  void absorb_small_patches(std::size_t columns);
  bool collect_patch(std::size_t start, std::size_t columns);

  FixedVector<float> ended_, passed_, scatter_, ended_share_around_, solid_, highest_;
  FixedVector<float> all_ended_, all_scatter_;
  FixedVector<std::uint8_t> loose_, seen_;
  FixedVector<std::uint32_t> patch_;  // cells that hang together
};

}  // namespace scree
