#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/terrain/endless_box.hpp"

namespace scree {

/// When beams last went through the space around the robot, in coarse cells. Bounded: the cells lie
/// in an EndlessBox, and a cell belongs to the place that was passed last.
class FreeSpace {
public:
  static constexpr float kCell = 0.25F;  ///< metres; the box is 32 m wide and 8 m high

  FreeSpace() : cells_(Box::kCells) { clear(); }

  void clear() { cells_.assign(cells_.capacity(), {}); }
  void pass(const Eigen::Vector3f& place, std::uint32_t sweep);
  /// The sweep that passed it last; 0 for none.
  std::uint32_t last_passed(const Eigen::Vector3f& place) const;

private:
  using Box = EndlessBox<128, 32>;

  struct Cell {
    Box::Place place;
    std::uint32_t sweep = 0;
  };

  FixedVector<Cell> cells_;
};

}  // namespace scree
