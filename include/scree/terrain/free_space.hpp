#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// When beams last went through the space around the robot, in coarse cells. Bounded: the cells lie
/// in a box that repeats endlessly, and a cell belongs to the place that was passed last.
class FreeSpace {
public:
  static constexpr float kCell = 0.25F;  ///< metres; the box is 32 m wide and 8 m high

  FreeSpace() : cells_(std::size_t{kWide} * kWide * kHigh) { clear(); }

  void clear() { cells_.assign(cells_.capacity(), {}); }
  void pass(const Eigen::Vector3f& place, std::uint32_t sweep);
  /// The sweep that passed it last; 0 for none.
  std::uint32_t last_passed(const Eigen::Vector3f& place) const;

private:
  static constexpr int kWide = 128, kHigh = 32;

  struct Cell {
    std::int16_t x = 0, y = 0, z = 0;
    std::uint32_t sweep = 0;
  };
  struct Place {
    std::int16_t x, y, z;
    std::size_t index;
  };
  static Place at(const Eigen::Vector3f& place);

  FixedVector<Cell> cells_;
};

}  // namespace scree
