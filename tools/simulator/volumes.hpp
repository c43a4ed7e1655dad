#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "scree/core/random.hpp"

namespace scree {

/// A body above the ground that light may pass through: a tuft of grass, a bush, a crown, a rail.
/// Light passes with a probability of exp(-density * path), so the mean free path is 1 / density
/// (Beer's law).
struct Volume {
  enum class Form : std::uint8_t { ellipsoid, box, cylinder };
  static constexpr double kSolid = std::numeric_limits<double>::infinity();

  /// A tuft of grass: the upper half of an ellipsoid; the lower one lies in the ground.
  /// @param base on the ground
  static Volume tuft(const Eigen::Vector3d& base, double radius, double height, double density);
  /// A round rod from one point to another.
  static Volume rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);
  /// An upright box.
  /// @param yaw of its length against x, radians
  static Volume block(const Eigen::Vector3d& center, const Eigen::Vector3d& half, double yaw);

  /// What a beam's middle loses: the share of light that passes along one of its axes.
  double light_along(int axis) const;
  /// Half of its extent along the world's axes, metres.
  Eigen::Vector3d reach() const;
  /// How far a beam goes until it enters it, metres; none where it does not, or begins inside.
  /// @pre direction has length 1
  std::optional<double> range_to(const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction) const;
  /// Out of its surface, of length 1. @param at on its surface
  Eigen::Vector3d normal(const Eigen::Vector3d& at) const;

  Form form = Form::ellipsoid;
  Eigen::Vector3d center{0, 0, 0};
  Eigen::Vector3d half{0.2, 0.2, 0.2};  ///< along its own axes, metres; a cylinder lies along its x
  double density = 4;                   ///< leaves or blades met a metre; kSolid: nothing passes
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< its own ones, in columns
  bool is_turned = false;                              ///< against the world's axes
  bool is_dark = false;                 ///< light that meets it does not come back, as with glass
  double darkest = 20, brightest = 50;  ///< reflectivity, 0..255
  std::uint16_t part = 0;               ///< of the feature that it belongs to, 0 for none
};

/// What a beam met first.
struct VolumeHit {
  double range;  ///< metres
  const Volume* volume;
};

/// The volumes of a terrain, sorted by place.
class Volumes {
public:
  Volumes() = default;
  /// @param size edge of the square centred on the origin in which they stand, metres
  Volumes(std::vector<Volume> volumes, double size);

  const std::vector<Volume>& all() const { return volumes_; }

  /// The leaf, blade or surface that a beam meets first; none when it passes all of them as far as
  /// max_range. Two beams on the same way need not meet the same blade.
  /// @pre direction has length 1
  std::optional<VolumeHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double max_range, Random& random) const;
  /// The first tuft of grass that covers the place, null for none.
  const Volume* at(double x, double y) const;
  /// Whether one of them stands within a distance of the place, or hangs above it.
  bool is_near(double x, double y, double distance) const;

  /// Calls visit with each volume in the place's cell: all that cover it and others beside it.
  template <class Visit>
  void for_each_near(double x, double y, Visit visit) const {
    if (volumes_.empty()) return;
    const std::size_t cell = cell_of(y) * cells_ + cell_of(x);
    for (std::uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) visit(volumes_[members_[i]]);
  }

private:
  std::size_t cell_of(double coordinate) const;

  /// An upright cylinder around a volume: most beams that come near it miss that one, too.
  struct Bounds {
    double x, y, squared_radius, bottom, top;
  };
  double half_ = 0;
  std::size_t cells_ = 0;  // a side
  std::vector<Volume> volumes_;
  std::vector<std::uint32_t> first_,
      members_;                          // of each cell: members_[first_[cell]..first_[cell + 1]]
  std::vector<Bounds> bounds_;           // of each volume
  std::vector<float> highest_, lowest_;  // of the volumes in each cell
  double top_ = 0;
};

}  // namespace scree
