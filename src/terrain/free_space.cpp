#include "scree/terrain/free_space.hpp"

namespace scree {
namespace {

constexpr float kInverse = 1 / FreeSpace::kCell;

}  // namespace

void FreeSpace::pass(const Eigen::Vector3f& place, std::uint32_t sweep) {
  const Box::Place there = Box::place(place, kInverse);
  cells_[there.index()] = {there, sweep};
}

std::uint32_t FreeSpace::last_passed(const Eigen::Vector3f& place) const {
  const Box::Place there = Box::place(place, kInverse);
  const Cell& cell = cells_[there.index()];
  return cell.place == there ? cell.sweep : 0;
}

}  // namespace scree
