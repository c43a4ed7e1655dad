#include "scree/terrain/free_space.hpp"

#include "scree/core/floor_to_cell.hpp"

namespace scree {

FreeSpace::Place FreeSpace::at(const Eigen::Vector3f& place) {
  const std::int32_t x = floor_to_cell(place.x() / kCell);
  const std::int32_t y = floor_to_cell(place.y() / kCell);
  const std::int32_t z = floor_to_cell(place.z() / kCell);
  const auto wrapped = [](std::int32_t value, int size) {
    return static_cast<std::size_t>(value & (size - 1));
  };
  return {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y), static_cast<std::int16_t>(z),
          (wrapped(z, kHigh) * kWide + wrapped(y, kWide)) * kWide + wrapped(x, kWide)};
}

void FreeSpace::pass(const Eigen::Vector3f& place, std::uint32_t sweep) {
  const Place there = at(place);
  cells_[there.index] = {there.x, there.y, there.z, sweep};
}

std::uint32_t FreeSpace::last_passed(const Eigen::Vector3f& place) const {
  const Place there = at(place);
  const Cell& cell = cells_[there.index];
  const bool is_same = cell.x == there.x && cell.y == there.y && cell.z == there.z;
  return is_same ? cell.sweep : 0;
}

}  // namespace scree
