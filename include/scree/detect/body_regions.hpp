#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/detect/beam_grid.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/ground_surface.hpp"
#include "scree/detect/key_sort.hpp"

namespace scree {

struct BodyRegionSettings {
  float tolerance;  ///< bodies closer than this with nothing seen between them are one, metres
  float saddle;     ///< two tops are two bodies above a saddle lower than this share of the lower
};

/// Clusters of the points above the ground's surface, and of those below it, on the surface's
/// raster. A cell that was not seen counts as what was seen nearest to it, up to half a tolerance
/// away; cells of bodies that then touch belong together. So shadows and the gaps between rings
/// part nothing, and ground that was seen between two rocks does. Rocks that touch are parted by
/// the watershed of their heights (Vincent and Soille, 1991), merged by the tops' prominence. What
/// lets light through counts as lower than it is, so that a rock rises out of the grass around it.
/// What hangs at the height of a crown is apart from what stands below it.
class BodyRegions {
public:
  BodyRegions(std::size_t max_points, std::size_t max_cells);

  /// @param bodies above (height > 0) or below the surface; all other points of the cloud that
  /// `surface` was built from count as seen ground
  /// @param solidity on the same raster
  void label(const CandidatePoints& bodies, const GroundSurface& surface, const BeamGrid& solidity,
             const BodyRegionSettings& settings);

  /// Region of each point, numbered from 0.
  std::span<const std::uint32_t> labels() const { return labels_; }
  /// Points of each region.
  std::span<const std::uint32_t> sizes() const { return sizes_; }

private:
  using State = std::uint8_t;  ///< what is seen in a cell; the greater one counts
  static constexpr State unseen = 0, clear = 1, hanging = 2, loose = 3, firm = 4;
  enum class Side : std::uint8_t { above, below };

  static bool is_on(Side side, float height) { return (height > 0) == (side == Side::above); }
  void mark(const CandidatePoints& bodies, Side side, const GroundSurface& surface,
            const BeamGrid& solidity);
  void grow(bool diagonally, float share);
  void join(float saddle);
  void number(const CandidatePoints& bodies, Side side, const GroundSurface& surface);

  std::size_t columns_ = 0;
  FixedVector<State> state_, grown_;
  FixedVector<float> top_, grown_top_;  // of the bodies in a cell, metres, weighed by solidity
  KeySort order_;                       // cells of bodies, the highest first
  FixedVector<std::uint32_t> parent_;   // union-find over them; a root is its region's top
  FixedVector<std::uint32_t> number_;   // of the region whose root a cell is
  FixedVector<std::uint32_t> labels_, sizes_;
};

}  // namespace scree
