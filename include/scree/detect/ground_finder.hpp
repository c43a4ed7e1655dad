#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "scree/core/fixed_vector.hpp"
#include "scree/detect/depressions.hpp"
#include "scree/detect/ground_trend.hpp"
#include "scree/detect/label.hpp"
#include "scree/detect/planar_windows.hpp"
#include "scree/detect/raster_fill.hpp"

namespace scree {

/// How a raster of square cells is laid out, row by row.
struct GroundRaster {
  std::size_t columns, rows;
  float cell_size;  ///< metres
};

struct GroundFinderSettings {
  float max_slope;    ///< steeper cells are no ground, metres per metre
  float tolerance;    ///< a smooth patch this close to the ground's surface belongs to it, metres
  float trend_reach;  ///< reach of GroundTrend, metres; 0: without it
};

/// Finds the ground in a raster of heights and lays a surface through it. Cells that are nowhere
/// steep make patches; the largest is ground, and so are those that lie in its continuation or on
/// the trend of the whole. What is left, the flanks and tops of rocks, the walls and floors of
/// holes, is spanned from the ground around it. Memory is taken once.
class GroundFinder {
public:
  static constexpr float kUnseen = std::numeric_limits<float>::quiet_NaN();  ///< as a height

  GroundFinder(const GroundFinderSettings& settings, std::size_t max_cells);

  /// A rough surface is right to some centimetres, and takes half the time.
  enum class Accuracy : std::uint8_t { full, rough };
  /// @param seen height in each cell, metres; kUnseen in all outermost cells. Afterwards
  /// they are the same but for rounding
  void find(const GroundRaster& raster, float* seen, Accuracy accuracy);

  // Of the last raster, by cell.
  bool is_ground(std::size_t cell) const { return ground_[cell] != 0; }
  /// z of the surface in the middle of each cell, metres.
  const float* levels() const { return smooth_.data(); }
  /// Whether a cell lies in a crater whose flanks are gentle enough for ground.
  bool is_crater(std::size_t cell) const { return depressions_.holds(cell); }
  /// Area of the smooth patch that a cell belongs to, square metres; 0: to none.
  float patch_area(std::size_t cell) const {
    return patch_[cell] == kNoLabel
               ? 0
               : static_cast<float>(patches_[patch_[cell]].cells) * cell_ * cell_;
  }

private:
  struct Patch {
    std::uint32_t cells = 0;
    float residual = 0;
    bool is_ground = false;
  };
  Patch& first_patch();
  bool has_trend() const { return settings_.trend_reach > 0; }
  void find_smooth_cells();
  void add_planar_cells();
  void find_patches();
  void join_windows();
  template <class Visit>
  void for_each_planar_cell(const Visit& visit) const;
  /// A tilt of the ground, metres a cell along rows and columns.
  struct Tilt {
    float along = 0, across = 0;
  };
  Tilt main_tilt() const;
  void add_tilt(const Tilt& tilt, float sign, float* heights) const;
  void join_trend();
  void join_patches(Accuracy accuracy);
  void mark_ground();
  void span(int steps);
  /// Mean height difference of the two neighbours of a cell (Sobel's 1-2-1 across), metres.
  float rise(std::size_t cell, std::size_t along, std::size_t across) const;
  float blurred(std::size_t cell) const;

  GroundFinderSettings settings_;
  float cell_ = 1;
  std::size_t columns_ = 0, rows_ = 0;
  float* seen_ = nullptr;      // height seen in each cell; NaN: no point
  FixedVector<float> smooth_;  // scratch: blurred heights, then the surface
  FixedVector<std::uint8_t> ground_;
  FixedVector<std::uint32_t> patch_;  // number of each cell's patch
  FixedVector<std::uint32_t> queue_;
  FixedVector<Patch> patches_;
  RasterFill fill_;
  GroundTrend trend_;
  // Without a trend.
  PlanarWindows windows_;
  Depressions depressions_;
};

}  // namespace scree
