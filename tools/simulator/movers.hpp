#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scoring/truth.hpp"
#include "simulator/footprint.hpp"
#include "simulator/motion.hpp"
#include "simulator/terrain.hpp"
#include "simulator/volumes.hpp"

namespace scree {

/// How many of each move around a robot.
struct MoverCounts {
  int people = 0, animals = 0, vehicles = 0;
  int all() const { return people + animals + vehicles; }
};

/// Something that moves by itself. Its own frame: x ahead, z up, the origin on the ground below its
/// middle.
struct Mover {
  std::string_view name;                   ///< person, animal or vehicle
  std::vector<Volume> bodies;              ///< solid, in its frame
  Footprint footprint;                     ///< in its frame
  double radius = 0;                       ///< of a circle around the footprint, metres
  double height = 0;                       ///< metres
  std::vector<TrueObstacle::Place> track;  ///< where it is in the terrain's frame, often enough
};

/// Draws them and their ways: across the robot's way, shortly ahead of it, now and then towards it
/// or away from it. Some stand for a while, or from then on, or begin to walk in its sight. They
/// keep clear of the robot, of all things on the terrain and of each other: those that find no such
/// way are left out. People walk at 0.5 to 1.8 m/s or run at up to 3, animals move at 0.5 to 3 m/s
/// and vehicles at 1 to 5. The same seed gives the same ones.
/// @param start_ns, end_ns of the time that counts
std::vector<Mover> draw_movers(const MoverCounts& counts, const Terrain& terrain,
                               const Motion& robot, std::int64_t start_ns, std::int64_t end_ns,
                               std::uint64_t seed);

/// What the truth says of one. @pre it has a track
TrueObstacle true_obstacle(const Mover& mover, int id, const Terrain& terrain);

/// Movers at one moment, as light meets them.
class PlacedMovers {
public:
  /// Keeps references to movers and terrain. The bodies of the first belong to part `first_part`,
  /// and so on.
  PlacedMovers(std::span<const Mover> movers, const Terrain& terrain, std::size_t first_part);

  void move_to(std::int64_t t_ns);
  /// What a beam meets first; none when it passes all of them as far as max_range.
  /// @pre direction has length 1
  std::optional<VolumeHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double max_range) const;

private:
  struct Placed {
    Eigen::Vector3d middle{0, 0, 0};  ///< of a ball around it
    double radius = 0;
    std::vector<Volume> bodies;
  };
  std::span<const Mover> movers_;
  const Terrain& terrain_;
  std::vector<Placed> placed_;
};

}  // namespace scree
