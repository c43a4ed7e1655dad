#include "scree/detect/planar_windows.hpp"

#include <algorithm>
#include <array>

namespace scree {
namespace {

constexpr std::array<std::size_t, 4> kHalves = {2, 4, 8, 16};  // half a window's side, cells
constexpr float kBankSlope = 0.7F;                             // 35 degrees
constexpr std::size_t kBankHalf = 16;                          // of windows that may be a bank

/// A sparse cloud has few cells in a small window, and noise alone may put three on a plane.
constexpr float kFewest = 7;
/// Cells must spread over this share of a window in both directions, as a standard deviation; the
/// share of a full window is 0.29.
constexpr float kSpread = 0.16F;
/// Standard deviation of the heights from the plane, metres: gravel, a rut, the sensor's noise.
constexpr float kRoughness = 0.03F;

}  // namespace

PlanarWindows::PlanarWindows(std::size_t max_cells)
    : blocks_(max_cells / 2 + 2), windows_(max_cells / 2 + 2) {}

void PlanarWindows::Moments::add(float px, float py, float pz) {
  ++count;
  x += px;
  y += py;
  z += pz;
  xx += px * px;
  xy += px * py;
  yy += py * py;
  xz += px * pz;
  yz += py * pz;
  zz += pz * pz;
}

void PlanarWindows::Moments::add(const Moments& other, float dx, float dy) {
  count += other.count;
  xx += other.xx + dx * (2 * other.x + dx * other.count);
  xy += other.xy + dx * other.y + dy * other.x + dx * dy * other.count;
  yy += other.yy + dy * (2 * other.y + dy * other.count);
  xz += other.xz + dx * other.z;
  yz += other.yz + dy * other.z;
  x += other.x + dx * other.count;
  y += other.y + dy * other.count;
  z += other.z;
  zz += other.zz;
}

void PlanarWindows::find(std::size_t columns, std::size_t rows, const float* heights,
                         float cell_size, float max_slope) {
  columns_ = columns;
  rows_ = rows;
  heights_ = heights;
  windows_.clear();
  for (const std::size_t half : kHalves) {
    gather(half);
    const std::size_t down = blocks_.size() / blocks_across_;
    for (std::size_t row = 0; row + 1 < down; ++row) {
      for (std::size_t column = 0; column + 1 < blocks_across_; ++column) {
        fit(column, row, half, cell_size, half >= kBankHalf ? kBankSlope : max_slope);
      }
    }
  }
}

void PlanarWindows::gather(std::size_t half) {
  blocks_across_ = (columns_ + half - 1) / half;
  blocks_.assign(blocks_across_ * ((rows_ + half - 1) / half), {});
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < columns_; ++column) {
      const float height = heights_[row * columns_ + column];
      if (std::isnan(height)) continue;
      blocks_[row / half * blocks_across_ + column / half].add(
          static_cast<float>(column % half), static_cast<float>(row % half), height);
    }
  }
}

/// Keeps the window of four blocks when its cells lie on a plane.
void PlanarWindows::fit(std::size_t column, std::size_t row, std::size_t half, float cell_size,
                        float max_slope) {
  const auto side = static_cast<float>(half);
  const Moments* const first = blocks_.begin() + row * blocks_across_ + column;
  Moments sum = first[0];
  sum.add(first[1], side, 0);
  sum.add(first[blocks_across_], 0, side);
  sum.add(first[blocks_across_ + 1], side, side);
  if (sum.count < kFewest) return;

  const float share = 1 / sum.count, x = share * sum.x, y = share * sum.y, z = share * sum.z;
  const float xx = share * sum.xx - x * x, xy = share * sum.xy - x * y;
  const float yy = share * sum.yy - y * y, zz = share * sum.zz - z * z;
  const float xz = share * sum.xz - x * z, yz = share * sum.yz - y * z;
  const float least = (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy);  // eigenvalue
  const float spread = kSpread * 2 * side;
  if (least < spread * spread) return;
  const float determinant = xx * yy - xy * xy;
  const float rise_x = (xz * yy - yz * xy) / determinant;
  const float rise_y = (yz * xx - xz * xy) / determinant;
  if (std::hypot(rise_x, rise_y) > max_slope * cell_size) return;
  if (zz - rise_x * xz - rise_y * yz > kRoughness * kRoughness) return;
  const std::size_t left = column * half, low = row * half;
  const PlanarWindow window{static_cast<std::uint32_t>(left),
                            static_cast<std::uint32_t>(low),
                            static_cast<std::uint32_t>(std::min(2 * half, columns_ - left)),
                            static_cast<std::uint32_t>(std::min(2 * half, rows_ - low)),
                            z - rise_x * x - rise_y * y,
                            rise_x,
                            rise_y};
  if (is_flat(window)) windows_.push_back(window);
}

/// Whether nothing sticks out of the plane: a low stone hardly changes the mean of a wide window.
bool PlanarWindows::is_flat(const PlanarWindow& window) const {
  constexpr float kOffPlane = 0.05F;    // metres
  constexpr std::size_t kMostOff = 20;  // one cell of so many
  std::size_t known = 0, off_plane = 0;
  for_each_cell(window, columns_, heights_, [&](std::size_t, float off) {
    ++known;
    if (std::abs(off) > kOffPlane) ++off_plane;
  });
  return kMostOff * off_plane <= known;
}

}  // namespace scree
