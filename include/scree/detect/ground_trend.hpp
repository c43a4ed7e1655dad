#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// How the ground runs on the whole, from what is known of a raster here and there: planes fitted
/// around each place by robust locally weighted regression (Cleveland, Robust Locally Weighted
/// Regression and Smoothing Scatterplots, 1979) to what a plane through all leaves over. It goes on
/// with the slope where rings lie far apart, and what stands on the ground or lies below it hardly
/// moves it. Memory is taken once.
class GroundTrend {
public:
  explicit GroundTrend(std::size_t max_cells);

  /// @param known not zero where `heights` counts. Row by row, `columns` a row.
  /// @param cell_size edge of a cell, metres
  /// @param reach standard deviation of the weights around a place, metres
  /// @pre columns * rows <= max_cells
  void fit(std::size_t columns, std::size_t rows, const std::uint8_t* known, const float* heights,
           float cell_size, float reach);

  /// At a cell of the raster, bilinear between the blocks' middles, metres.
  float at(std::size_t column, std::size_t row) const;

private:
  struct Block {
    float height = 0;  ///< mean of the known cells
    float weight = 0;  ///< 0: nothing known
    float plane = 0;   ///< through the whole raster
    float trend = 0;
    float counts = 0;  ///< weight in the next round
  };
  void gather(std::size_t columns, std::size_t rows, const std::uint8_t* known,
              const float* heights, float cell_size);
  void fit_whole();
  void weigh_by_distance(float reach);  // in blocks
  void fit_around();
  float left_over(std::size_t column, std::size_t row) const;

  static constexpr std::size_t kMostWindow = 64;  // blocks to each side

  std::size_t side_ = 1;  // of a block, cells
  std::size_t columns_ = 0, rows_ = 0;
  FixedVector<Block> blocks_;
  FixedVector<float> kernel_;  // weight by distance in blocks, along one axis
};

}  // namespace scree
