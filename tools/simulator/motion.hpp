#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scree/core/pose.hpp"

namespace scree {

/// Where `base` is at every moment, in the terrain's frame: poses at equal intervals, straight
/// lines between them; before the first and after the last the robot stands.
class Motion {
public:
  /// A robot that stands.
  explicit Motion(const Pose& base) : knots_{base} {}
  /// @pre at least one knot
  Motion(std::vector<Pose> knots, std::int64_t start_ns, std::int64_t step_ns);

  Pose base(std::int64_t t_ns) const;
  /// Metres driven along the way since the first knot.
  double distance(std::int64_t t_ns) const;

  std::int64_t start_ns() const { return start_ns_; }
  std::int64_t step_ns() const { return step_ns_; }

private:
  struct Interpolation {
    std::size_t knot;
    double share;  ///< of the next knot
  };
  Interpolation interpolation(std::int64_t t_ns) const;

  std::vector<Pose> knots_;
  std::vector<double> distance_{0};
  std::int64_t start_ns_ = 0, step_ns_ = 1;
};

}  // namespace scree
