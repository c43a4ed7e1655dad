#include "draw/height_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace scree::cli {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostAway = 1e6;  // metres; farther off no cell has a number

std::int64_t key_of(std::int32_t column, std::int32_t row) {
  return static_cast<std::int64_t>(row) * (std::int64_t{1} << 32) + column;
}
/// Column and row.
std::pair<std::int32_t, std::int32_t> place_of(std::int64_t key) {
  const auto column = static_cast<std::int32_t>(key & 0xFFFFFFFF);
  return {column, static_cast<std::int32_t>((key - column) >> 32)};
}

std::int32_t index_of(double coordinate, double cell) {
  return static_cast<std::int32_t>(std::floor(coordinate / cell));
}

/// The mean of what was added.
struct Mean {
  double sum = 0;
  std::size_t count = 0;

  void add(double value) {
    sum += value;
    ++count;
  }
  float value() const {
    return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : kUnknown;
  }
};

/// The mean within `radius` cells of each one that is known.
std::vector<float> smooth(const HeightGrid& grid, std::ptrdiff_t radius) {
  const auto columns = static_cast<std::ptrdiff_t>(grid.columns);
  const auto rows = static_cast<std::ptrdiff_t>(grid.rows);
  const std::ptrdiff_t stride = columns + 1;
  // Sums over all cells below and to the left.
  std::vector<Mean> sums(static_cast<std::size_t>(stride * (rows + 1)));
  const auto sum = [&](std::ptrdiff_t column, std::ptrdiff_t row) -> Mean& {
    return sums[static_cast<std::size_t>(row * stride + column)];
  };
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    for (std::ptrdiff_t column = 0; column < columns; ++column) {
      const float height = grid.heights[static_cast<std::size_t>(row * columns + column)];
      const bool is_known = std::isfinite(height);
      const Mean &left = sum(column, row + 1), &below = sum(column + 1, row),
                 &both = sum(column, row);
      sum(column + 1, row + 1) = {left.sum + below.sum - both.sum + (is_known ? height : 0),
                                  left.count + below.count - both.count + (is_known ? 1 : 0)};
    }
  }
  std::vector<float> means(grid.heights.size());
  for (std::ptrdiff_t row = 0; row < rows; ++row) {
    const std::ptrdiff_t y0 = std::max<std::ptrdiff_t>(0, row - radius),
                         y1 = std::min(rows, row + radius + 1);
    for (std::ptrdiff_t column = 0; column < columns; ++column) {
      const std::ptrdiff_t x0 = std::max<std::ptrdiff_t>(0, column - radius);
      const std::ptrdiff_t x1 = std::min(columns, column + radius + 1);
      const Mean all{sum(x1, y1).sum - sum(x0, y1).sum - sum(x1, y0).sum + sum(x0, y0).sum,
                     sum(x1, y1).count - sum(x0, y1).count - sum(x1, y0).count + sum(x0, y0).count};
      means[static_cast<std::size_t>(row * columns + column)] = all.value();
    }
  }
  return means;
}

}  // namespace

void HeightRaster::add(const PointView& points, const Pose& frame) {
  constexpr double kClearance = 2;  // metres
  std::vector<std::pair<std::int64_t, float>> placed;
  placed.reserve(points.size());
  std::unordered_map<std::int64_t, float> lowest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d place = frame * Eigen::Vector3d(points.x[i], points.y[i], points.z[i]);
    if (!(place.cwiseAbs().maxCoeff() < kMostAway)) continue;
    const auto key = key_of(index_of(place.x(), cell_), index_of(place.y(), cell_));
    const auto height = static_cast<float>(place.z());
    placed.emplace_back(key, height);
    const auto [at, is_new] = lowest.try_emplace(key, height);
    if (!is_new) at->second = std::min(at->second, height);
  }
  std::unordered_map<std::int64_t, Mean> means;
  for (const auto& [key, height] : placed) {
    if (height < lowest[key] + kClearance) means[key].add(height);
  }
  for (const auto& [key, mean] : means) cells_[key] = mean.value();
}

void HeightRaster::add(const ObstacleGrid& grid) {
  if (cells_.empty() && grid.cell_size > 0) cell_ = grid.cell_size;
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const std::int16_t ground = grid.ground[row * grid.columns + column];
      if (ground == ObstacleGrid::kNoGround) continue;
      const Eigen::Vector2d middle = grid.middle(column, row);
      if (!(middle.cwiseAbs().maxCoeff() < kMostAway)) continue;
      cells_[key_of(index_of(middle.x(), cell_), index_of(middle.y(), cell_))] =
          static_cast<float>(grid.pose.translation.z() + ground / 100.0);
    }
  }
}

HeightGrid HeightRaster::grid(std::size_t most_cells) const {
  if (cells_.empty()) return {};
  constexpr auto kLeast = std::numeric_limits<std::int32_t>::min(),
                 kMost = std::numeric_limits<std::int32_t>::max();
  std::int32_t x0 = kMost, x1 = kLeast, y0 = kMost, y1 = kLeast;
  for (const auto& [key, height] : cells_) {
    const auto [column, row] = place_of(key);
    x0 = std::min(x0, column);
    x1 = std::max(x1, column);
    y0 = std::min(y0, row);
    y1 = std::max(y1, row);
  }
  int shift = 0;
  const auto cells = [&](std::int32_t low, std::int32_t high) {
    return static_cast<std::size_t>(std::int64_t{high >> shift} - (low >> shift) + 1);
  };
  while (cells(x0, x1) * cells(y0, y1) > most_cells) ++shift;
  HeightGrid grid;
  grid.cell = cell_ * (1 << shift);
  grid.x = (x0 >> shift) * grid.cell;
  grid.y = (y0 >> shift) * grid.cell;
  grid.columns = cells(x0, x1);
  grid.rows = cells(y0, y1);
  std::vector<Mean> means(grid.columns * grid.rows);
  for (const auto& [key, height] : cells_) {
    const auto [column, row] = place_of(key);
    means[cells(y0, row) * grid.columns - grid.columns + cells(x0, column) - 1].add(height);
  }
  grid.heights.reserve(means.size());
  for (const Mean& mean : means) grid.heights.push_back(mean.value());
  return grid;
}

void fill_gaps(HeightGrid& grid, int times) {
  for (int time = 0; time < times; ++time) {
    const std::vector<float> means = smooth(grid, 1);
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (!std::isfinite(grid.heights[i])) grid.heights[i] = means[i];
    }
  }
}

std::vector<float> hillshade(const HeightGrid& grid) {
  constexpr double kAround = 0.8;  // metres
  constexpr float kFlat = 0.7071F, kRelief = 0.9F;
  const auto radius = std::max<std::ptrdiff_t>(1, std::lround(kAround / std::max(grid.cell, 0.01)));
  const std::vector<float> around = smooth(grid, radius);
  std::vector<float> bright(grid.heights.size(), kUnknown);
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const float height = grid.at(column, row);
      if (!std::isfinite(height)) continue;
      const auto of = [&](std::size_t x, std::size_t y) {
        const float there = grid.at(std::min(x, grid.columns - 1), std::min(y, grid.rows - 1));
        return std::isfinite(there) ? there : height;
      };
      const auto step = static_cast<float>(2 * grid.cell);
      const float slope_x = (of(column + 1, row) - of(column - (column > 0 ? 1 : 0), row)) / step;
      const float slope_y = (of(column, row + 1) - of(column, row - (row > 0 ? 1 : 0))) / step;
      const float lit = (-0.5F * slope_x - 0.5F * slope_y + kFlat) /
                        std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
      const float relief =
          std::clamp(kRelief * (height - around[row * grid.columns + column]), -0.5F, 0.15F);
      bright[row * grid.columns + column] =
          std::clamp(0.2F + 0.85F * std::max(0.0F, lit) + relief, 0.05F, 1.0F);
    }
  }
  return bright;
}

}  // namespace scree::cli
