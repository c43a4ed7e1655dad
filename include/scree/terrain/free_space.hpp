#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/terrain/endless_box.hpp"

namespace scree {

/// When beams last went through the space around the robot and how many ended there, in coarse
/// cells. Bounded: the cells lie in an EndlessBox, and a cell belongs to the place that a beam came
/// to last.
class FreeSpace {
public:
  static constexpr float kCell = 0.25F;  ///< metres; the box is 32 m wide and 8 m high

  FreeSpace() : cells_(Box::kCells) { clear(); }

  void clear() { cells_.assign(cells_.capacity(), {}); }
  /// @param beams that went through
  void pass(const Eigen::Vector3f& place, std::uint32_t sweep, std::uint16_t beams);
  /// One that ended there.
  void end(const Eigen::Vector3f& place);
  /// The sweep that passed it last; 0 for none.
  std::uint32_t last_passed(const Eigen::Vector3f& place) const;
  /// Of the last thousands of beams that came to it, the share that ended there; 1 where none came.
  float ended_share(const Eigen::Vector3f& place) const;

private:
  using Box = EndlessBox<128, 32>;

  struct Cell {
    Box::Place place;
    std::uint32_t sweep = 0;
    std::uint16_t ended = 0, passed = 0;
  };

  Cell& cell_for(const Eigen::Vector3f& place);
  /// Null where no beam came.
  const Cell* find(const Eigen::Vector3f& place) const;

  FixedVector<Cell> cells_;
};

}  // namespace scree
