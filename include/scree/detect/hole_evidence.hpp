#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/obstacle.hpp"
#include "scree/core/seen_cloud.hpp"
#include "scree/detect/candidate_points.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree {

/// Tells holes from points that only lie below what was taken for the ground. A hole is what light
/// went into: the beams that reached its points passed the level of its rim where no ground was
/// seen, and ground is known on enough of the rim. Points behind a wall, below the top of a bush,
/// or below ground that was itself seen are none.
class HoleEvidence {
public:
  explicit HoleEvidence(std::size_t max_cells);

  /// Follows the beams that went below the surface.
  void build(const SeenCloud& cloud, const GroundSurface& surface);

  /// Whether beams went below the level of the ground in a cell, and no ground was seen there.
  bool is_void(std::size_t cell) const { return beams_below_[cell] > 0; }
  /// Beams that passed over a cell in which nothing is seen, and ended farther on or did not come
  /// back; and z of the lowest of them, metres.
  std::uint16_t lost_beams(std::size_t cell) const { return lost_beams_[cell]; }
  float lowest_beam(std::size_t cell) const { return lowest_beam_[cell]; }
  /// The same of those that ended somewhere. None does that went into still water.
  float lowest_return(std::size_t cell) const { return lowest_return_[cell]; }

  /// What says that a cluster of points below the surface is a hole; none: nothing does.
  /// @param members of the cluster among the points
  Evidence of(std::span<const std::uint32_t> members, const CandidatePoints& points,
              const GroundSurface& surface);
  /// The share of that cluster's rim with ground near it.
  float rim() const { return rim_; }

private:
  static constexpr std::size_t kTile = 16;  // cells on a side

  void follow(const Eigen::Vector3f& origin, const Eigen::Vector3f& end,
              const GroundSurface& surface);
  void follow_over_gap(const Eigen::Vector3f& origin, const Eigen::Vector3f& end,
                       const GroundSurface& surface);
  static bool is_on_floor(const Eigen::Vector3f& place, const GroundSurface& surface);
  void find_tops(const GroundSurface& surface);
  int steps_above(const Eigen::Vector3f& place, const Eigen::Vector3f& direction,
                  const GroundSurface& surface) const;
  void follow_passing(const PassingBeam& beam, const GroundSurface& surface);
  void mark_lost(const Eigen::Vector3f& from, const Eigen::Vector3f& end, bool has_return,
                 const GroundSurface& surface);
  void add_lost(std::size_t cell, float height, bool has_return);
  void collect_cells(std::span<const std::uint32_t> members, const CandidatePoints& points,
                     const GroundSurface& surface);
  void close_gaps(const GroundSurface& surface);
  float rim_share(const GroundSurface& surface);
  bool has_ground_near(std::size_t cell, const GroundSurface& surface);

  bool knows_beams_ = false;
  float rim_ = 0;
  Eigen::Vector2f robot_ = Eigen::Vector2f::Zero();
  float reach_ = 0;                           // metres around the robot, see SeenCloud
  FixedVector<float> into_, through_ground_;  // beams that ended below the ground, by cell
  FixedVector<std::uint16_t> beams_below_, lost_beams_;
  FixedVector<float> lowest_beam_, lowest_return_;
  FixedVector<float> tops_;  // by tile, metres
  std::size_t tile_columns_ = 0;
  FixedVector<std::uint32_t> cells_, taken_by_;  // of the cluster, and the void beside it
  std::size_t seen_cells_ = 0;                   // the first of them: those with members
  enum class Near : std::uint8_t { unknown, ground, nothing };
  FixedVector<Near> near_;  // by cell: what has_ground_near() found
  std::uint32_t number_ = 0;
};

}  // namespace scree
