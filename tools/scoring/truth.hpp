#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scoring/footprints.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/pose.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// A rock, a hole, or someone who walks by: what is truly there.
struct TrueObstacle {
  /// Where it is at a time.
  struct Place {
    std::int64_t t_ns;
    Eigen::Vector2d position;
    double yaw;  ///< radians
  };
  int id = 0;
  ObstacleKind kind = ObstacleKind::positive;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Outline footprint;
  double height = 0;  ///< above the ground around, metres; below zero: depth
  std::string shape;  ///< what it is ("boulder", "ditch", ...); empty: unknown
  /// Of one that moves: centre and footprint are those at its first place.
  std::vector<Place> track = {};

  bool moves() const { return !track.empty(); }
  /// Centre and footprint at a time: between two places interpolated, before the first and after
  /// the last one as there.
  TrueObstacle at(std::int64_t t_ns) const;
  /// x, y at a time, m/s: from 0.1 s before to 0.1 s after it.
  Eigen::Vector2d velocity_at(std::int64_t t_ns) const;
};

/// Between two places interpolated, before the first and after the last one as there.
/// @pre !track.empty()
TrueObstacle::Place place_at(const std::vector<TrueObstacle::Place>& track, std::int64_t t_ns);

/// What truth.json says: one gravity-aligned world frame, metres.
struct Truth {
  struct TimedPose {
    std::int64_t t_ns;
    Pose base;
  };
  /// Obstacles that a sweep asks for, and those that may be found or not.
  struct Sight {
    std::int64_t t_ns;
    std::vector<int> ids, ignore;
  };
  std::vector<TrueObstacle> obstacles;
  std::vector<TimedPose> poses;
  std::vector<Sight> visible;

  /// Pose of base: between two poses interpolated, before the first and after the last one of
  /// these. @pre !poses.empty()
  Pose pose_at(std::int64_t t_ns) const;
};

/// Reads truth.json. Refused are, beside what is no JSON or lacks a member: an id that stands twice
/// or that no obstacle has, a footprint without area, times that fall, a file without poses. A
/// footprint that crosses itself becomes its convex hull. The error names file, place and fault.
Result<Truth> read_truth(const std::filesystem::path& file);

/// Writes it, lengths rounded to 0.1 mm. Fails when it cannot be written.
Result<void> write_truth(const std::filesystem::path& file, const Truth& truth);

}  // namespace scree
