#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>

#include "scree/core/beam_count.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree {

/// A beam that ended beyond the cloud, or nowhere.
struct PassingBeam {
  Eigen::Vector3f origin;     ///< metres
  Eigen::Vector3f direction;  ///< of length 1
  float range;                ///< to where it ended, metres; kNoReturnRange: nowhere
};

/// A cloud with what is known of the beams that saw it, in the cloud's frame. A span is empty where
/// nothing is known.
struct SeenCloud {
  PointView points;
  std::span<const BeamCount> beams{};          ///< what came to each point
  std::span<const Eigen::Vector3f> origins{};  ///< where each point was seen from; or one for all
  std::span<const PassingBeam> passing{};
  std::optional<Eigen::Vector2f> robot{};  ///< where it stands
  /// Metres around the robot: what was seen farther off is not in the cloud.
  float reach = std::numeric_limits<float>::infinity();

  /// @pre origins are known
  const Eigen::Vector3f& origin_of(std::size_t point) const {
    return origins[origins.size() == 1 ? 0 : point];
  }
};

}  // namespace scree
