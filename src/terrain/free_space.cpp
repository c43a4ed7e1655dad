#include "scree/terrain/free_space.hpp"

namespace scree {
namespace {

constexpr float kInverseCell = 1 / FreeSpace::kCell;

/// Both counts are halved after this many beams, so that what comes to a cell that was long free
/// shows soon.
constexpr int kMaxBeams = 2048;

}  // namespace

FreeSpace::Cell& FreeSpace::cell_for(const Eigen::Vector3f& point) {
  const Grid::CellIndex index = Grid::index_of(point, kInverseCell);
  Cell& cell = cells_[index.slot()];
  if (cell.index != index) cell = {.index = index};
  if (cell.hits + cell.misses >= kMaxBeams) {
    cell.hits /= 2;
    cell.misses /= 2;
  }
  return cell;
}

void FreeSpace::add_misses(const Eigen::Vector3f& point, std::uint32_t sweep, std::uint16_t beams) {
  Cell& cell = cell_for(point);
  cell.last_miss = sweep;
  cell.misses += beams;
}

void FreeSpace::add_hit(const Eigen::Vector3f& point) {
  ++cell_for(point).hits;
}

const FreeSpace::Cell* FreeSpace::find(const Eigen::Vector3f& point) const {
  const Grid::CellIndex index = Grid::index_of(point, kInverseCell);
  const Cell& cell = cells_[index.slot()];
  return cell.index == index && cell.hits + cell.misses > 0 ? &cell : nullptr;
}

std::uint32_t FreeSpace::last_miss(const Eigen::Vector3f& point) const {
  const Cell* const cell = find(point);
  return cell == nullptr ? 0 : cell->last_miss;
}

float FreeSpace::hit_ratio(const Eigen::Vector3f& point) const {
  const Cell* const cell = find(point);
  if (cell == nullptr) return 1;
  return static_cast<float>(cell->hits) / static_cast<float>(cell->hits + cell->misses);
}

}  // namespace scree
