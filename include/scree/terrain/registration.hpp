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
  struct KeyPoint {
    Eigen::Vector3f place;  ///< in `base`
    float before_s;         ///< the sweep's end, when it was measured
  };
  /// What the key points say about the state at one pose.
  template <class Evidence>
  struct Linearization {
    Evidence evidence;
    double squares = 0, weights = 0;  ///< weighted sum of the squared distances, m^2; its weights
    int count = 0;                    ///< correspondences
  };
  template <class Filter>
  Linearization<typename Filter::Evidence> linearize(const Filter& filter, double uncertainty,
                                                     double shared, SurfelMap& map) const;
  void choose_key_points(const DeskewedSweep& sweep, SurfelMap& map, const Pose& pose);

  FixedVector<KeyPoint> key_points_;
  FixedVector<std::uint8_t> bins_;
};

}  // namespace scree
