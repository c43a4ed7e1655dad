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

/// A rock or a hole that is truly there.
struct TrueObstacle {
  int id = 0;
  ObstacleKind kind = ObstacleKind::positive;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Outline footprint;
  double height = 0;  ///< above the ground around, metres; below zero: depth
  std::string shape;  ///< what it is ("boulder", "ditch", ...); empty: unknown
};

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
