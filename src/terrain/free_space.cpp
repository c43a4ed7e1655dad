#include "scree/terrain/free_space.hpp"

namespace scree {
namespace {

constexpr float kInverse = 1 / FreeSpace::kCell;

/// Beams after which both counts are halved: what comes to a place that was long free shows soon.
constexpr int kMostBeams = 2048;

}  // namespace

FreeSpace::Cell& FreeSpace::cell_for(const Eigen::Vector3f& place) {
  const Box::Place there = Box::place(place, kInverse);
  Cell& cell = cells_[there.index()];
  if (cell.place != there) cell = {.place = there};
  if (cell.ended + cell.passed >= kMostBeams) {
    cell.ended /= 2;
    cell.passed /= 2;
  }
  return cell;
}

void FreeSpace::pass(const Eigen::Vector3f& place, std::uint32_t sweep, std::uint16_t beams) {
  Cell& cell = cell_for(place);
  cell.sweep = sweep;
  cell.passed += beams;
}

void FreeSpace::end(const Eigen::Vector3f& place) {
  ++cell_for(place).ended;
}

const FreeSpace::Cell* FreeSpace::find(const Eigen::Vector3f& place) const {
  const Box::Place there = Box::place(place, kInverse);
  const Cell& cell = cells_[there.index()];
  return cell.place == there && cell.ended + cell.passed > 0 ? &cell : nullptr;
}

std::uint32_t FreeSpace::last_passed(const Eigen::Vector3f& place) const {
  const Cell* const cell = find(place);
  return cell == nullptr ? 0 : cell->sweep;
}

float FreeSpace::ended_share(const Eigen::Vector3f& place) const {
  const Cell* const cell = find(place);
  if (cell == nullptr) return 1;
  return static_cast<float>(cell->ended) / static_cast<float>(cell->ended + cell->passed);
}

}  // namespace scree
