#include "scree/terrain/surfel_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr float kMinPoints = 30;
/// A plane of this many points stays: a map that takes in all that is laid onto it moves with the
/// pose, and drifts. On simulated drives the error of the yaw is a quarter smaller by it.
constexpr float kSettledPoints = 100;
/// One point in so many still counts in a settled plane, lest what has changed be kept for ever.
constexpr int kSettledStride = 16;
/// A cell that has seen this many points halves the weight of the old ones.
constexpr float kMaxPoints = 300;
/// A plane's narrower direction spreads at least this much: a single ring is a line.
constexpr float kMinWidth = 0.12F;  // of the cell's edge

}  // namespace

SurfelMap::SurfelMap(float cell, int width, int height)
    : cell_(cell),
      inverse_(1 / cell),
      width_(width),
      height_(height),
      numbers_(static_cast<std::size_t>(width) * static_cast<std::size_t>(width) *
               static_cast<std::size_t>(height)),
      cells_(2 * static_cast<std::size_t>(width) * static_cast<std::size_t>(width)) {
  cells_.resize(cells_.capacity());
  clear();
}

std::size_t SurfelMap::slot(const Grid::CellIndex& index) const {
  const auto wrapped = [](std::int32_t value, int size) {
    return static_cast<std::size_t>(value & (size - 1));
  };
  const auto width = static_cast<std::size_t>(width_);
  return (wrapped(index.z, height_) * width + wrapped(index.y, width_)) * width +
         wrapped(index.x, width_);
}

void SurfelMap::clear() {
  numbers_.assign(numbers_.capacity(), 0);
  for (Cell& cell : cells_) cell.is_used = false;
  next_ = 0;
}

SurfelMap::Cell* SurfelMap::find(const Grid::CellIndex& index) {
  const std::uint32_t number = numbers_[slot(index)];
  if (number == 0) return nullptr;
  Cell& cell = cells_[number - 1];
  return cell.index == index ? &cell : nullptr;
}

SurfelMap::Cell& SurfelMap::find_or_add(const Grid::CellIndex& index) {
  std::uint32_t& number = numbers_[slot(index)];
  if (number == 0) {
    Cell& oldest = cells_[next_];
    if (oldest.is_used) numbers_[slot(oldest.index)] = 0;
    number = static_cast<std::uint32_t>(next_ + 1);
    next_ = (next_ + 1) % cells_.size();
    oldest.is_used = false;
  }
  Cell& cell = cells_[number - 1];
  if (!cell.is_used || cell.index != index) {
    cell = Cell();
    cell.index = index;
    cell.is_used = true;
  }
  return cell;
}

Eigen::Vector3f SurfelMap::middle(const Cell& cell) const {
  return Eigen::Vector3f(static_cast<float>(cell.index.x) + 0.5F,
                         static_cast<float>(cell.index.y) + 0.5F,
                         static_cast<float>(cell.index.z) + 0.5F) *
         cell_;
}

void SurfelMap::add(const Eigen::Vector3f& point) {
  Cell& cell = find_or_add(Grid::index_of(point, inverse_));
  if (cell.is_plane && cell.points >= kSettledPoints && ++cell.left_out % kSettledStride != 0)
    return;
  if (cell.points > kMaxPoints) {
    constexpr float kFade = 0.5F;
    cell.points *= kFade;
    cell.sum *= kFade;
    for (float* moment : {&cell.xx, &cell.xy, &cell.xz, &cell.yy, &cell.yz, &cell.zz}) {
      *moment *= kFade;
    }
  }
  const Eigen::Vector3f d = point - middle(cell);
  ++cell.points;
  cell.sum += d;
  cell.xx += d.x() * d.x();
  cell.xy += d.x() * d.y();
  cell.xz += d.x() * d.z();
  cell.yy += d.y() * d.y();
  cell.yz += d.y() * d.z();
  cell.zz += d.z() * d.z();
  cell.is_fresh = false;
}

const Surfel* SurfelMap::at(const Eigen::Vector3f& point) {
  Cell* const cell = find(Grid::index_of(point, inverse_));
  if (cell == nullptr) return nullptr;
  if (!cell->is_fresh) fit(*cell);
  return cell->is_plane ? &cell->surfel : nullptr;
}

void SurfelMap::fit(Cell& cell) const {
  cell.is_fresh = true;
  cell.is_plane = false;
  if (cell.points < kMinPoints) return;
  const Eigen::Vector3f mean = cell.sum / cell.points;
  Eigen::Matrix3f covariance;
  covariance << cell.xx, cell.xy, cell.xz, cell.xy, cell.yy, cell.yz, cell.xz, cell.yz, cell.zz;
  covariance = covariance / cell.points - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3f deviations = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  if (deviations[1] < kMinWidth * cell_ || deviations[0] > 0.5F * deviations[1]) return;
  Surfel& surfel = cell.surfel;
  surfel.normal = solver.eigenvectors().col(0);
  if (surfel.normal.z() < 0) surfel.normal = -surfel.normal;
  surfel.center = mean + middle(cell);
  surfel.thickness = deviations[0];
  surfel.width = deviations[1];
  surfel.points = cell.points;
  cell.is_plane = true;
}

}  // namespace scree
