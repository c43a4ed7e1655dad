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

/// A plane in blocks and metres, by weighted least squares.
class Plane {
public:
  void add(float x, float y, float z, float weight) {
    const Eigen::Vector3f row(1, x, y);
    normal_ += weight * row * row.transpose();
    right_ += weight * z * row;
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

}  // namespace

GroundTrend::GroundTrend(std::size_t max_cells)
    : blocks_(max_cells / 2 + 2), kernel_(kMostWindow + 1) {}

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
  side_ = std::max(static_cast<std::size_t>(std::lround(kBlock / cell_size)), kLeastSide);
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
      for (std::size_t column = 0; column < columns_; ++column) {
        const Block& block = blocks_[row * columns_ + column];
        if (block.weight == 0) continue;
        plane.add(static_cast<float>(column), static_cast<float>(row), block.height,
                  block.weight * robust(block.height - block.trend, scale));
      }
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
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      Block& here = blocks_[row * columns_ + column];
      here.trend = here.plane + residual_at(column, row);
    }
  }
}

/// Fits a plane around a block to the residuals of the plane through the whole raster.
/// @return its height at the block, metres
float GroundTrend::residual_at(std::size_t column, std::size_t row) const {
  Plane plane;
  const std::size_t window = kernel_.size() - 1;
  const auto away = [](std::size_t a, std::size_t b) { return a > b ? a - b : b - a; };
  for (std::size_t v = row - std::min(window, row); v <= std::min(row + window, rows_ - 1); ++v) {
    for (std::size_t u = column - std::min(window, column);
         u <= std::min(column + window, columns_ - 1); ++u) {
      const Block& block = blocks_[v * columns_ + u];
      if (block.counts == 0) continue;
      plane.add(static_cast<float>(u) - static_cast<float>(column),
                static_cast<float>(v) - static_cast<float>(row), block.height - block.plane,
                block.counts * kernel_[away(u, column)] * kernel_[away(v, row)]);
    }
  }
  return plane.solve()[0];
}

float GroundTrend::at(std::size_t column, std::size_t row) const {
  const auto split = [this](std::size_t cell, std::size_t count, float& share) {
    const float place = (static_cast<float>(cell) + 0.5F) / static_cast<float>(side_) - 0.5F;
    const float inside = std::clamp(place, 0.0F, static_cast<float>(count - 1));
    const auto low = std::min(static_cast<std::size_t>(inside), count > 1 ? count - 2 : 0);
    share = inside - static_cast<float>(low);
    return low;
  };
  float u = 0, v = 0;
  const std::size_t left = split(column, columns_, u), low = split(row, rows_, v);
  const std::size_t right = std::min(left + 1, columns_ - 1), high = std::min(low + 1, rows_ - 1);
  const auto trend = [this](std::size_t c, std::size_t r) {
    return blocks_[r * columns_ + c].trend;
  };
  const float near = trend(left, low) + u * (trend(right, low) - trend(left, low));
  const float far = trend(left, high) + u * (trend(right, high) - trend(left, high));
  return near + v * (far - near);
}

}  // namespace scree
