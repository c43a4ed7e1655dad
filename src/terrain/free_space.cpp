#include "scree/terrain/free_space.hpp"

#include <limits>

namespace scree {
namespace {

constexpr float kInverseCell = 1 / FreeSpace::kCell;

/// Both counts are halved after this many beams, so that what comes to a cell that was long free
/// shows soon.
constexpr int kMaxBeams = 2048;
/// So many beams must go through a cell that was hit for each one that ended there.
constexpr int kEmptyRatio = 100;

/// Calls visit with the 26 cells around one.
template <class Index, class Visit>
void for_each_neighbour(const Index& index, Visit visit) {
  for (std::int32_t z = -1; z <= 1; ++z) {
    for (std::int32_t y = -1; y <= 1; ++y) {
      for (std::int32_t x = -1; x <= 1; ++x) {
        if (x != 0 || y != 0 || z != 0) visit(Index{index.x + x, index.y + y, index.z + z});
      }
    }
  }
}

void count(std::uint8_t& number) {
  if (number < std::numeric_limits<std::uint8_t>::max()) ++number;
}

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
  constexpr std::uint8_t kEnough = 4, kLookEvery = 8;  // sweeps
  Cell& cell = cell_for(point);
  cell.misses += beams;
  if (cell.last_miss == sweep) return;
  cell.last_miss = sweep;
  if (sweep - cell.last_hit <= 1) return;
  cell.stays = 0;
  count(cell.passes);
  if (cell.is_clear || cell.passes % kLookEvery != kEnough) return;
  cell.is_clear = kEmptyRatio * cell.hits <= cell.misses && has_empty_neighbours(cell.index);
}

void FreeSpace::add_beams(const Eigen::Vector3f& from, const Eigen::Vector3f& along, float end,
                          std::uint32_t sweep, std::uint16_t beams) {
  for (float way = 0; way < end; way += kCell) add_misses(from + way * along, sweep, beams);
}

void FreeSpace::add_hit(const Eigen::Vector3f& point, std::uint32_t sweep) {
  constexpr std::uint8_t kStaysClear = 20, kSettled = 10;  // sweeps
  Cell& cell = cell_for(point);
  if (cell.last_hit != sweep) count(cell.stays);
  const bool is_first = cell.last_hit != sweep;
  cell.last_hit = sweep;
  if (cell.is_clear && cell.stays >= kStaysClear) {
    cell.is_clear = false;
    disturb_neighbours(cell.index);
  }
  ++cell.hits;
  if (cell.is_clear) return;
  cell.passes = 0;
  if (is_first && cell.stays == kSettled) disturb_neighbours(cell.index);
}

bool FreeSpace::has_empty_neighbours(const Grid::CellIndex& index) const {
  bool is_empty = true;
  for_each_neighbour(index, [&](const Grid::CellIndex& beside) {
    const Cell* const cell = find(beside);
    if (cell != nullptr && kEmptyRatio * cell->hits > cell->misses) is_empty = false;
  });
  return is_empty;
}

/// Something stays in a cell: its outermost parts may lie in those beside it.
void FreeSpace::disturb_neighbours(const Grid::CellIndex& index) {
  for_each_neighbour(index, [&](const Grid::CellIndex& beside) {
    Cell& cell = cells_[beside.slot()];
    if (cell.index == beside) cell.is_clear = false;
  });
}

const FreeSpace::Cell* FreeSpace::find(const Grid::CellIndex& index) const {
  const Cell& cell = cells_[index.slot()];
  return cell.index == index && cell.hits + cell.misses > 0 ? &cell : nullptr;
}

const FreeSpace::Cell* FreeSpace::find(const Eigen::Vector3f& point) const {
  return find(Grid::index_of(point, kInverseCell));
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

bool FreeSpace::is_nearly_empty(const Eigen::Vector3f& point, std::uint32_t look) {
  const Grid::CellIndex index = Grid::index_of(point, kInverseCell);
  Cell& cell = cells_[index.slot()];
  if (cell.index != index) return false;
  if (cell.look != look) {
    cell.look = look;
    cell.is_nearly_empty = stops_little(point);
  }
  return cell.is_nearly_empty;
}

bool FreeSpace::stops_little(const Eigen::Vector3f& point) const {
  // The densest puffs of dust in simulated drives stop 5 to 8 % of the beams.
  constexpr float kLittle = 0.1F;
  if (hit_ratio(point) >= kLittle) return false;
  for (const float side : {-kCell, kCell}) {
    for (int axis = 0; axis < 3; ++axis) {
      const float ratio = hit_ratio(point + side * Eigen::Vector3f::Unit(axis));
      if (ratio >= kLittle && ratio < 1) return false;  // 1: a grain may be all that came
    }
  }
  return true;
}

bool FreeSpace::is_clear(const Eigen::Vector3f& point) const {
  const Cell* const cell = find(point);
  return cell != nullptr && cell->is_clear;
}

FreeSpace::Presence FreeSpace::presence(const Eigen::Vector3f& point, std::uint32_t sweep) const {
  constexpr std::uint16_t kFewest = 3;  // hits
  constexpr std::uint32_t kRecent = 3;  // sweeps
  const Cell* const cell = find(point);
  if (cell == nullptr || cell->hits < kFewest) return Presence::unknown;
  if (sweep - cell->last_hit < kRecent) return Presence::there;
  return sweep - cell->last_miss < kRecent ? Presence::gone : Presence::unknown;
}

bool FreeSpace::is_seen_through(const Eigen::Vector3f& point, std::uint32_t sweep) const {
  const Cell* const cell = find(point);
  return cell != nullptr && sweep - cell->last_miss <= 1 && sweep - cell->last_hit > 1;
}

}  // namespace scree
