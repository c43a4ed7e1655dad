#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// How the ground runs on the whole, from what is known of a raster here and there. A plane is
/// fitted to all heights, and to its residuals a plane around each place, by robust locally
/// weighted regression (Cleveland, Robust Locally Weighted Regression and Smoothing Scatterplots,
/// 1979). The trend goes on with the slope where rings lie far apart, and what stands on the ground
/// or lies below it hardly moves it. Memory is taken once.
class GroundTrend {
public:
  explicit GroundTrend(std::size_t max_cells);

  /// Fits the trend to a raster, given row by row.
  /// @param known for each cell whether `heights` counts; 0: it does not
  /// @param heights of the cells, metres
  /// @param cell_size edge of a cell, metres
  /// @param reach standard deviation of the weights around a place, metres
  /// @pre columns * rows <= max_cells
  void fit(std::size_t columns, std::size_t rows, const std::uint8_t* known, const float* heights,
           float cell_size, float reach);

  /// Adds the trend's height, metres, times a factor to each cell of a raster of the same layout.
  void add_to(float* heights, float factor);

private:
  struct Block {
    float height = 0;  ///< mean of the known cells, metres
    float weight = 0;  ///< from 0, nothing known, to 1
    float plane = 0;   ///< height of the plane through the whole raster, metres
    float trend = 0;   ///< height of the trend, metres
    float counts = 0;  ///< weight in the next round
  };
  /// Weighted sums over blocks in a row, places counted from one of them.
  struct RowMoments {
    float weight = 0, x = 0, xx = 0, z = 0, xz = 0;
    void add(float at, float residual, float counts);
  };
  class Plane;
  /// A cell's place between two rows or two columns of blocks.
  struct Place {
    std::size_t low, high;
    float share;  ///< of the way from the middle of the lower
  };
  Place place_of(std::size_t cell, std::size_t count) const;
  void gather(std::size_t columns, std::size_t rows, const std::uint8_t* known,
              const float* heights, float cell_size);
  void fit_whole();
  void weigh_by_distance(float reach);  // in blocks
  void fit_around();
  void sum_rows();
  float residual_at(std::size_t column, std::size_t row) const;
  void interpolate_row(std::size_t block_row, float* out) const;

  static constexpr std::size_t kMostWindow = 64;  // blocks to each side

  std::size_t side_ = 1;  // cells along the side of a block
  std::size_t columns_ = 0, rows_ = 0;
  std::size_t cell_columns_ = 0, cell_rows_ = 0;
  FixedVector<Block> blocks_;
  FixedVector<RowMoments> moments_;  // around each block, in its row
  FixedVector<float> kernel_;        // weight by distance in blocks, along one axis
  FixedVector<float> along_;         // the trend along two rows of blocks, by columns of cells
};

}  // namespace scree
