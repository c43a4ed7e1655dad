#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "scree/core/random.hpp"

namespace scree {

/// A tuft of grass: the upper half of an ellipsoid filled with blades. Light passes through it with
/// a probability of exp(-density * path), so the mean free path is 1 / density (Beer's law).
struct Tuft {
  Eigen::Vector3d base;  ///< on the ground
  double radius = 0.2;   ///< metres
  double height = 0.2;   ///< metres
  double density = 4;    ///< blades met a metre
};

/// The tufts of a terrain, sorted by place.
class Tufts {
public:
  Tufts() = default;
  /// @param size edge of the square centred on the origin in which they stand, metres
  Tufts(std::vector<Tuft> tufts, double size);

  const std::vector<Tuft>& all() const { return tufts_; }

  /// Distance to the blade that a beam meets first, metres; none when it passes between all of them
  /// as far as max_range. Two beams on the same way need not meet the same blade.
  /// @pre direction has length 1, origin lies outside all tufts
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range, Random& random) const;
  /// The tuft that covers the place, null for none.
  const Tuft* at(double x, double y) const;

private:
  std::size_t cell_of(double coordinate) const;

  double half_ = 0;
  std::size_t cells_ = 0;  // a side
  std::vector<Tuft> tufts_;
  std::vector<std::uint32_t> first_,
      members_;                 // of each cell: members_[first_[cell]..first_[cell + 1]]
  std::vector<float> highest_;  // top of the tufts in each cell
  double top_ = 0;
};

}  // namespace scree
