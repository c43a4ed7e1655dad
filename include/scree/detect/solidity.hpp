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

/// Of the beams that came to what stands above the ground the share that ended there, and how much
/// the ranges of those scatter, on the raster of the ground's surface. Rocks stop them all; between
/// blades of grass most go on, and the others end as deep in it as they happen to.
class Solidity {
public:
  /// Ranges on a rock scatter less than this, metres: by the sensor's noise.
  static constexpr float kFirmScatter = 0.02F;

  explicit Solidity(std::size_t max_cells)
      : ended_(max_cells),
        passed_(max_cells),
        scatter_(max_cells),
        around_(max_cells),
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

  // Of a cell of the raster; without any beam all is solid.
  float ended(std::size_t cell) const { return ended_[cell]; }
  float passed(std::size_t cell) const { return passed_[cell]; }
  float scatter(std::size_t cell) const { return scatter_[cell]; }
  /// Beams that ended in points which stop at least nine of ten and hardly scatter them.
  float solid(std::size_t cell) const { return solid_[cell]; }
  /// Of the points at any height up to the highest.
  float all_ended(std::size_t cell) const { return all_ended_[cell]; }
  float all_scatter(std::size_t cell) const { return all_scatter_[cell]; }
  float of(std::size_t cell) const { return share(ended_[cell], passed_[cell]); }
  /// Whether beams ended on what stands in it, and hardly any went on.
  bool stops_all(std::size_t cell) const { return ended_[cell] > 0 && of(cell) >= kAll; }
  /// Of the cells up to two cells away, too.
  float around(std::size_t cell) const { return around_[cell]; }
  /// Of the points that were counted, metres above the surface; 0 without any.
  float highest(std::size_t cell) const { return highest_[cell]; }
  /// Whether the ranges scatter, there and in the cells next to it, as they do among blades. At
  /// least six cells are so together, unless they stand alone.
  bool is_loose(std::size_t cell) const { return loose_[cell] != 0; }
  bool has_loose() const { return std::ranges::find(loose_, 1) != loose_.end(); }
  /// Of all cells, not 0: is_loose().
  std::span<const std::uint8_t> loose() const { return {loose_.data(), loose_.size()}; }

  /// One more beam ended than was counted: few beams say little.
  static float share(float ended, float passed) { return (ended + 1) / (ended + passed + 1); }

private:
  static constexpr std::uint8_t kFirm = 0, kLoose = 1;
  /// Voxels at an edge count beams that went past it, too.
  static constexpr float kAll = 0.94F;

  void spread(std::size_t columns);
  void settle(std::size_t columns);
  bool gather(std::size_t start, std::size_t columns);

  FixedVector<float> ended_, passed_, scatter_, around_, solid_, highest_, all_ended_, all_scatter_;
  FixedVector<std::uint8_t> loose_, seen_;
  FixedVector<std::uint32_t> patch_;  // cells that hang together
};

}  // namespace scree
