#pragma once

#include <span>
#include <vector>

#include "scree/core/pose.hpp"
#include "simulator/lidar.hpp"

namespace scree {

/// Which obstacles a sensor has seen well enough to be asked for. A shot counts when it hits a
/// rock, or lands inside a hole, more than 5 cm off the ground around.
///
/// From one sweep: 20 shots of at least two lasers.
///
/// On a drive, all sweeps together, shots from any distance: 80 shots in at least three sweeps and,
/// for a hole, one at 40 % of its depth or deeper, because a brink alone could be anything; and the
/// obstacle lies now where a planner asks: its centre within 10 m of `base` and more than 0.5 m
/// ahead of it. Stones and dents are never asked for.
///
/// A mover is asked for while its middle is within 8 m of `base` and more than 0.5 m ahead of it
/// and the last sweep had 15 shots on it.
///
/// Of a long obstacle two of its parts, a metre each, are enough: 20 shots in three sweeps on each,
/// and both lie where a planner asks. Those of an edge, where the ground ends, are asked for within
/// 5 m only, and shots on the last half metre of the ground before it count too.
class Visibility {
public:
  /// Keeps references to terrain and movers.
  explicit Visibility(const Terrain& terrain, std::span<const Mover> movers = {})
      : terrain_(terrain), movers_(movers), hits_(terrain.parts().size() + movers.size()) {}

  /// Counts shots in the order of firing. @pre the first is of laser 0
  void add(std::span<const SimulatedShot> shots);
  /// Closes the sweep: what it showed well enough counts as seen from now on.
  void end_sweep();

  std::vector<int> seen() const;      ///< obstacles that one sweep has shown well enough
  std::vector<int> not_seen() const;  ///< all the others, stones and dents too

  struct Sight {
    std::vector<int> ids, ignore;  ///< asked for, and all the others
  };
  /// What a robot at this pose is asked for after the sweeps so far. Movers have the ids after
  /// those of the features.
  Sight asked_for(const Pose& base, std::int64_t t_ns = 0) const;

private:
  struct Hits {
    int shots = 0;        ///< of this sweep
    int last_shots = 0;   ///< of the last one
    unsigned lasers = 0;  ///< one bit each
    bool seen = false;
    int all_shots = 0, sweeps = 0;
    float furthest = 0;  ///< above or below the ground, metres
  };
  bool is_known(const TerrainFeature& feature) const;
  bool is_seen(const TerrainFeature& feature) const;
  /// Whether enough of it is known and lies where a planner asks.
  bool is_due(const TerrainFeature& feature, const Pose& base) const;

  bool is_due(const Mover& mover, int shots, const Pose& base, std::int64_t t_ns) const;

  const Terrain& terrain_;
  std::span<const Mover> movers_;
  std::vector<Hits> hits_;  // of each part
};

}  // namespace scree
