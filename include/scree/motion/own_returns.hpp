#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/pose.hpp"

namespace scree {

/// Returns from the robot itself. Those in the boxes of its body are used for nothing. A watch
/// notices others: seen from the lidar they keep their distance while all farther off changes, and
/// they are bounded: they do not go on into what is seen beside them. It puts boxes around them.
///
/// Not noticed is what lies lower than 0.15 m above the origin of `base`, where level ground keeps
/// its distance too, and what lies farther than 2.35 m from the lidar, where a wall beside the way
/// does.
class OwnReturns {
public:
  static constexpr std::size_t kMostFound = 8;

  /// @param body boxes in `base`
  /// @param mount lidar -> base
  OwnReturns(std::span<const BodyBox> body, const Pose& mount);

  /// Takes the next return of a sweep.
  /// @param point in the lidar's frame, metres
  /// @return whether it lies in a box: of the body, or one found
  bool take(const Eigen::Vector3f& point);
  /// Whether the last one taken has kept its distance for some sweeps, so that it should not
  /// correct the pose.
  bool is_suspect() const { return is_suspect_; }
  /// @param way metres that the robot moved within the sweep; a turn counts by the way of a place
  /// half a metre off
  /// @return whether a box was found
  bool end_sweep(float way);
  /// As if no return of the sweep under way had come: they come again.
  void forget_sweep();

  std::span<const BodyBox> found() const { return {found_.data(), found_.size()}; }
  /// Returns in boxes within the last sweep.
  std::size_t returns() const { return last_returns_; }

private:
  /// What is seen in one direction.
  struct Bin {
    Eigen::Vector3f nearest =
        Eigen::Vector3f::Zero();  ///< return of this sweep, in the lidar's frame
    float range = 0;              ///< of it, metres; 0: none
    float kept = 0;               ///< the range that it keeps, metres
    float first = 0;              ///< the first one of those, metres
    float way = 0;                ///< that the robot moved meanwhile, metres
    std::uint8_t sweeps = 0;      ///< in which it was kept, up to 255
  };

  bool covers(const Eigen::Vector3f& in_base) const;
  bool look_for_boxes();
  bool robot_moves() const;
  bool persists(const Bin& bin) const;
  bool find_around(std::size_t start);

  Eigen::Isometry3f to_base_;
  FixedVector<BodyBox> body_, found_;
  FixedVector<Bin> bins_;
  FixedVector<std::uint8_t> visited_;
  FixedVector<std::uint32_t> members_;
  std::size_t returns_ = 0, last_returns_ = 0;
  bool is_suspect_ = false;
};

}  // namespace scree
