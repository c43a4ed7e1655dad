#pragma once

#include <array>
#include <span>
#include <vector>

#include "simulator/lidar.hpp"

namespace scree {

/// Which obstacles a sensor has seen well enough to be asked for: in one sweep at least 20 shots of
/// at least two lasers hit the rock, or land inside the hole, more than 5 cm off the ground around.
class Visibility {
public:
  explicit Visibility(const Terrain& terrain) : terrain_(terrain) {}

  /// Counts shots in the order of firing. @pre the first is of laser 0
  void add(std::span<const SimulatedShot> shots);
  /// Closes the sweep: what it showed well enough counts as seen from now on.
  void end_sweep();

  std::vector<int> seen() const;      ///< ids of obstacles
  std::vector<int> not_seen() const;  ///< ids of the other obstacles

private:
  struct Hits {
    int shots = 0;
    unsigned lasers = 0;  ///< one bit each
    bool seen = false;
  };
  std::vector<int> ids(bool seen) const;

  const Terrain& terrain_;
  std::array<Hits, Terrain::kMostFeatures + 1> hits_{};
};

}  // namespace scree
