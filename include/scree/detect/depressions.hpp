#pragma once

#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// A raster of heights, row by row.
struct HeightRaster {
  std::size_t columns, rows;
  float cell_size;       ///< metres
  const float* heights;  ///< metres, all known
};

/// Finds craters whose flanks are nowhere too steep to be ground: closed depressions where a tenth
/// of the area slopes by 18 degrees or more, and that are 0.25 m deep or more below the lowest
/// place of their rim; or 12 degrees around a floor, and 0.2 m. Hollows of the ground are gentler,
/// and slope everywhere. Water is let in from the raster's edge, lowest places first (priority
/// flood; Barnes, Lehman and Mulla 2014), and what it must rise to is the rim.
class Depressions {
public:
  explicit Depressions(std::size_t max_cells);

  /// Takes the cells of each such depression from the ground.
  /// @return whether there is any
  bool remove(const HeightRaster& raster, FixedVector<std::uint8_t>& ground);

  /// Whether a cell was taken by the last remove().
  bool holds(std::size_t cell) const { return cell < is_taken_.size() && is_taken_[cell] != 0; }
  void clear() { is_taken_.clear(); }

private:
  struct Shore {
    float level;
    std::uint32_t cell;
    bool operator<(const Shore& other) const { return level > other.level; }  // lowest first
  };

  void flood(const HeightRaster& raster);
  void reach(std::size_t cell, float level, const HeightRaster& raster);
  void collect(std::size_t start, const HeightRaster& raster);
  bool has_flanks(float depth, float area);
  bool is_crater(const HeightRaster& raster, const FixedVector<std::uint8_t>& ground);

  FixedVector<float> level_;           // of the water in each cell
  FixedVector<Shore> shore_;           // heap of the cells next to dry ones
  FixedVector<std::uint8_t> is_done_;  // flooded, then collected
  FixedVector<std::uint8_t> is_taken_;
  FixedVector<std::uint32_t> cells_;  // of one depression
  FixedVector<float> slopes_;         // of these
};

}  // namespace scree
