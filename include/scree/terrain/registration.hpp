#pragma once

#include "scree/motion/deskew.hpp"
#include "scree/motion/pose_filter.hpp"
#include "scree/motion/twist_filter.hpp"
#include "scree/terrain/surfel_map.hpp"

namespace scree {

/// The second step of registration (paper's reference 36, an improved ICP on key points): lays a
/// sweep onto the surfels around it, point to plane, and corrects the filter's pose by what they
/// bind. Key points are those on flat (curvature), well-filled (density) surfels, taken evenly from
/// all directions of their normals. A correspondence counts within a threshold that follows the
/// pose's uncertainty and the surfel's thickness.
class Registration {
public:
  explicit Registration(std::size_t max_points);

  struct Outcome {
    int key_points = 0, rounds = 0;
    double residual = 0;    ///< root of the mean square of the distances, metres
    double correction = 0;  ///< metres
  };
  /// @param sweep in `base`, or for a TwistFilter in the lidar's frame
  /// @tparam Filter PoseFilter or TwistFilter
  template <class Filter>
  Outcome align(const DeskewedSweep& sweep, SurfelMap& map, Filter& filter);

private:
  /// What the key points at one pose say about it.
  struct Linearization {
    PoseEvidence evidence;
    double squares = 0, weights = 0;  ///< weighted sum of the squared distances, m^2; its weights
    int count = 0;                    ///< correspondences
  };
  Linearization linearize(const Pose& pose, double uncertainty, double shared,
                          SurfelMap& map) const;
  void choose_key_points(const DeskewedSweep& sweep, SurfelMap& map, const Pose& pose);

  FixedVector<Eigen::Vector3f> key_points_;  // in `base`
  FixedVector<std::uint8_t> bins_;
};

}  // namespace scree
