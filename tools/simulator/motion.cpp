#include "simulator/motion.hpp"

#include <utility>

namespace scree {

Motion::Motion(std::vector<Pose> knots, std::int64_t start_ns, std::int64_t step_ns)
    : knots_(std::move(knots)), start_ns_(start_ns), step_ns_(step_ns) {
  distance_.reserve(knots_.size());
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    const Eigen::Vector3d moved = knots_[i].translation - knots_[i - 1].translation;
    // Vibration shakes the body up and down without driving it on.
    const Eigen::Vector3d forward = knots_[i].rotation * Eigen::Vector3d::UnitX();
    distance_.push_back(distance_.back() + moved.dot(forward));
    // Neighbours on the same side of the sphere, or a line between them would turn the long way.
    Eigen::Quaterniond& q = knots_[i].rotation;
    if (q.dot(knots_[i - 1].rotation) < 0) q.coeffs() = -q.coeffs();
  }
}

Motion::Interpolation Motion::interpolation(std::int64_t t_ns) const {
  if (t_ns <= start_ns_ || knots_.size() == 1) return {0, 0};
  const std::int64_t since = t_ns - start_ns_;
  const auto knot = static_cast<std::size_t>(since / step_ns_);
  if (knot + 1 >= knots_.size()) return {knots_.size() - 1, 0};
  return {knot, static_cast<double>(since % step_ns_) / static_cast<double>(step_ns_)};
}

Pose Motion::base(std::int64_t t_ns) const {
  const auto [knot, share] = interpolation(t_ns);
  const Pose& a = knots_[knot];
  if (share == 0) return a;
  const Pose& b = knots_[knot + 1];
  Pose between;
  between.translation = a.translation + share * (b.translation - a.translation);
  between.rotation.coeffs() =
      a.rotation.coeffs() + share * (b.rotation.coeffs() - a.rotation.coeffs());
  between.rotation.normalize();
  return between;
}

double Motion::distance(std::int64_t t_ns) const {
  const auto [knot, share] = interpolation(t_ns);
  if (share == 0) return distance_[knot];
  return distance_[knot] + share * (distance_[knot + 1] - distance_[knot]);
}

}  // namespace scree
