#include "scree/detect/ground_trend.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace scree {
namespace {

constexpr float kBlock = 1;            // side of a block, metres
constexpr std::size_t kLeastSide = 4;  // cells
// From round to round, metres: a block that is off by more hardly counts. In the first round all
// count alike.
constexpr std::array kScales = {1e6F, 0.6F, 0.3F, 0.15F};

/// Weight of a block that lies this far from the trend (Geman and McClure's).
float robust(float distance, float scale) {
  const float ratio = distance / scale;
  const float inlier = 1 / (1 + ratio * ratio);
  return inlier * inlier;
}

std::size_t gap(std::size_t a, std::size_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace

void GroundTrend::RowMoments::add(float at, float residual, float counts) {
  weight += counts;
  x += counts * at;
  xx += counts * at * at;
  z += counts * residual;
  xz += counts * at * residual;
}

/// A plane in blocks and metres, by weighted least squares.
class GroundTrend::Plane {
public:
  void add(const RowMoments& row, float y, float weight) {
    Eigen::Matrix3f moments;
    moments << row.weight, row.x, y * row.weight,  //
        row.x, row.xx, y * row.x,                  //
        y * row.weight, y * row.x, y * y * row.weight;
    normal_ += weight * moments;
    right_ += weight * Eigen::Vector3f(row.z, row.xz, y * row.z);
  }
  /// Level, at height zero, where nothing speaks against it.
  Eigen::Vector3f solve() const {
    constexpr float kHeight = 0.001F, kSlope = 1;  // weights of a ridge regression
    Eigen::Matrix3f normal = normal_;
    normal.diagonal() += Eigen::Vector3f(kHeight, kSlope, kSlope);
    return normal.ldlt().solve(right_);
  }

private:
  Eigen::Matrix3f normal_ = Eigen::Matrix3f::Zero();
  Eigen::Vector3f right_ = Eigen::Vector3f::Zero();
};

GroundTrend::GroundTrend(std::size_t max_cells)
    : blocks_(max_cells / 4 + 2),
      moments_(blocks_.capacity()),
      kernel_(kMostWindow + 1),
      along_(2 * max_cells) {}

void GroundTrend::fit(std::size_t columns, std::size_t rows, const std::uint8_t* known,
                      const float* heights, float cell_size, float reach) {
  gather(columns, rows, known, heights, cell_size);
  fit_whole();
  weigh_by_distance(reach / (static_cast<float>(side_) * cell_size));
  for (const float scale : kScales) {
    for (Block& block : blocks_) {
      block.counts = block.weight * robust(block.height - block.trend, scale);
    }
    fit_around();
  }
}

void GroundTrend::gather(std::size_t columns, std::size_t rows, const std::uint8_t* known,
                         const float* heights, float cell_size) {
  along_.resize(2 * columns);
  side_ = std::max(static_cast<std::size_t>(std::lround(kBlock / cell_size)), kLeastSide);
  cell_columns_ = columns;
  cell_rows_ = rows;
  columns_ = (columns + side_ - 1) / side_;
  rows_ = (rows + side_ - 1) / side_;
  blocks_.assign(columns_ * rows_, {});
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t cell = row * columns + column;
      if (known[cell] == 0) continue;
      Block& block = blocks_[row / side_ * columns_ + column / side_];
      block.height += heights[cell];
      ++block.weight;
    }
  }
  for (Block& block : blocks_) {
    if (block.weight == 0) continue;
    block.height /= block.weight;
    block.weight = std::min(block.weight / static_cast<float>(side_), 1.0F);
  }
}

void GroundTrend::fit_whole() {
  for (const float scale : kScales) {
    Plane plane;
    for (std::size_t row = 0; row < rows_; ++row) {
      RowMoments moments;
      for (std::size_t column = 0; column < columns_; ++column) {
        const Block& block = blocks_[row * columns_ + column];
        moments.add(static_cast<float>(column), block.height,
                    block.weight * robust(block.height - block.trend, scale));
      }
      plane.add(moments, static_cast<float>(row), 1);
    }
    const Eigen::Vector3f fitted = plane.solve();
    for (std::size_t row = 0; row < rows_; ++row) {
      for (std::size_t column = 0; column < columns_; ++column) {
        Block& block = blocks_[row * columns_ + column];
        block.plane = block.trend =
            fitted.dot(Eigen::Vector3f(1, static_cast<float>(column), static_cast<float>(row)));
      }
    }
  }
}

void GroundTrend::weigh_by_distance(float reach) {
  const auto window = static_cast<std::size_t>(std::ceil(2 * reach));
  kernel_.resize(std::min(window, kMostWindow) + 1);
  for (std::size_t i = 0; i < kernel_.size(); ++i) {
    const float away = static_cast<float>(i) / reach;
    kernel_[i] = std::exp(-0.5F * away * away);
  }
}

void GroundTrend::fit_around() {
  sum_rows();
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      Block& here = blocks_[row * columns_ + column];
      here.trend = here.plane + residual_at(column, row);
    }
  }
}

/// The weights are a product of one along a row and one across it, so the sums are taken in turn.
void GroundTrend::sum_rows() {
  const std::size_t window = kernel_.size() - 1;
  moments_.resize(blocks_.size());
  for (std::size_t row = 0; row < rows_; ++row) {
    const Block* const blocks = blocks_.data() + row * columns_;
    for (std::size_t column = 0; column < columns_; ++column) {
      RowMoments& moments = moments_[row * columns_ + column] = {};
      const std::size_t last = std::min(column + window, columns_ - 1);
      for (std::size_t u = column - std::min(window, column); u <= last; ++u) {
        moments.add(static_cast<float>(u) - static_cast<float>(column),
                    blocks[u].height - blocks[u].plane, blocks[u].counts * kernel_[gap(u, column)]);
      }
    }
  }
}

/// Fits a plane around a block to the residuals of the plane through the whole raster.
/// @return its height at the block, metres
float GroundTrend::residual_at(std::size_t column, std::size_t row) const {
  Plane plane;
  const std::size_t window = kernel_.size() - 1;
  for (std::size_t v = row - std::min(window, row); v <= std::min(row + window, rows_ - 1); ++v) {
    plane.add(moments_[v * columns_ + column], static_cast<float>(v) - static_cast<float>(row),
              kernel_[gap(v, row)]);
  }
  return plane.solve()[0];
}

GroundTrend::Place GroundTrend::place_of(std::size_t cell, std::size_t count) const {
  const float place = (static_cast<float>(cell) + 0.5F) / static_cast<float>(side_) - 0.5F;
  const float inside = std::clamp(place, 0.0F, static_cast<float>(count - 1));
  const auto low = std::min(static_cast<std::size_t>(inside), count > 1 ? count - 2 : 0);
  return {low, std::min(low + 1, count - 1), inside - static_cast<float>(low)};
}

void GroundTrend::interpolate_row(std::size_t block_row, float* out) const {
  const Block* const blocks = blocks_.data() + block_row * columns_;
  for (std::size_t column = 0; column < cell_columns_; ++column) {
    const Place place = place_of(column, columns_);
    const float low = blocks[place.low].trend, high = blocks[place.high].trend;
    out[column] = low + place.share * (high - low);
  }
}

/// Bilinear between the middles of the blocks. Many rows of cells lie between the same two rows of
/// blocks: along these the trend is interpolated once.
void GroundTrend::add_to(float* heights, float factor) {
  float* const near = along_.data();
  float* const far = near + cell_columns_;
  std::size_t last = rows_;
  for (std::size_t row = 0; row < cell_rows_; ++row, heights += cell_columns_) {
    const Place place = place_of(row, rows_);
    if (place.low != last) {
      interpolate_row(place.low, near);
      interpolate_row(place.high, far);
      last = place.low;
    }
    for (std::size_t column = 0; column < cell_columns_; ++column) {
      heights[column] += factor * (near[column] + place.share * (far[column] - near[column]));
    }
  }
}

}  // namespace scree
