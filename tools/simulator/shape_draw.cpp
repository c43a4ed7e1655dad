#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/shape.hpp"

namespace scree {
namespace {

/// How much of a long shape's half length one end takes at most.
constexpr double kLongestEnd = 0.6;
constexpr double kLongestRock = 1.3;  ///< half of its length, metres
constexpr double kWidestHole = 1.3;   ///< half of its width, metres
constexpr double kUpright = 0.03;     ///< width of a pillar's flank, metres

/// Distance from the middle of a square of half width 1 to its edge; its corners are a little worn.
double rounded_square(double angle) {
  constexpr double kPower = 6;
  return std::pow(
      std::pow(std::abs(std::cos(angle)), kPower) + std::pow(std::abs(std::sin(angle)), kPower),
      -1 / kPower);
}

}  // namespace

Shape Shape::draw(ShapeKind kind, Random& random, std::optional<SizeRange> size) {
  Shape shape;
  shape.kind_ = kind;
  const double yaw = random.uniform(-std::numbers::pi, std::numbers::pi);
  shape.cos_yaw_ = std::cos(yaw);
  shape.sin_yaw_ = std::sin(yaw);
  shape.draw_size(random, size);
  if (is_positive(kind)) {
    shape.draw_rock(random);
  } else if (is_negative(kind)) {
    shape.draw_hole(random);
  } else {
    const double width = random.uniform(0.8, 2.5);
    shape.semi_axes_ = {width * random.uniform(1.0, 1.6), width};
    shape.irregularity_ = 0.1;
  }
  shape.draw_outline(random);
  const double length = shape.semi_axes_.x();
  const double largest = *std::max_element(shape.outline_.begin(), shape.outline_.end());
  const double beyond = kind == ShapeKind::crater ? 1.5 : 1.0;
  shape.reach_ =
      is_long(kind)
          ? std::hypot(length, shape.semi_axes_.y() + std::abs(shape.bend_) * length * length)
          : length * largest * beyond;
  if (!is_positive(kind) && !is_negative(kind)) {
    shape.size_ = 1;
    shape.size_ = std::tan(radians(random.uniform(8, 19))) / shape.steepest_slope();
  }
  return shape;
}

void Shape::undercut(Random& random) {
  const double slimmer = random.uniform(0.6, 1.0);
  semi_axes_ *= slimmer;
  reach_ *= slimmer;
  widest_ = random.uniform(0.1, 0.5);
  contact_ = random.uniform(kind_ == ShapeKind::log ? 0.0 : 0.4, 0.95);
}

void Shape::draw_size(Random& random, std::optional<SizeRange> size) {
  if (size) {
    size_ = random.uniform(size->low, size->high);
  } else if (kind_ == ShapeKind::pillar) {
    size_ = random.uniform(0.3, 1.6);
  } else if (is_positive(kind_) && is_long(kind_)) {
    size_ = random.uniform(0.15, 0.5);
  } else if (is_positive(kind_)) {
    const double drawn = random.uniform();
    size_ = 0.15 + 1.05 * drawn * std::sqrt(drawn);  // more small rocks than large ones
  } else {
    size_ = random.uniform(0.2, 1.0);
  }
}

void Shape::draw_rock(Random& random) {
  const double narrowest = std::min(0.15, size_);
  double width = std::max(narrowest, size_ * random.uniform(0.45, 1.1));
  double length =
      width * (random.chance(0.25) ? random.uniform(1.6, 3.0) : random.uniform(1.0, 1.5));
  length = std::min(length, std::max(width, kLongestRock));
  switch (kind_) {
    case ShapeKind::block:
      sharpness_ = random.uniform(0.12, 0.35);
      detail_ = random.uniform(0, 0.35);
      break;
    case ShapeKind::peak:
      sharpness_ = random.uniform(0.7, 1.1);
      break;
    case ShapeKind::bump:
      width = size_ * random.uniform(1.0, 1.7);
      length = width * random.uniform(1.0, 1.4);
      break;
    case ShapeKind::log:
      width = size_ * random.uniform(0.5, 1.1);
      length = random.uniform(0.5, 1.5);
      bend_ = random.uniform(-0.05, 0.05);
      break;
    case ShapeKind::ledge:
      return draw_ledge(random);
    case ShapeKind::pillar:
      return draw_pillar(random);
    default:
      sharpness_ = random.uniform(0.35, 0.6);
  }
  semi_axes_ = {length, width};
}

void Shape::draw_ledge(Random& random) {
  detail_ = random.chance(0.5) ? 1 : 0;
  // A ramp is at least so wide that it can be climbed.
  const double width = detail_ > 0 ? size_ * random.uniform(1.2, 2.0) : random.uniform(0.12, 0.5);
  const double length = random.uniform(0.5, 1.5);
  sharpness_ = random.uniform(0.1, 0.3);
  bend_ = random.uniform(-0.1, 0.1);
  end_ = random.uniform(0.04, 0.3);
  semi_axes_ = {length, width};
}

void Shape::draw_pillar(Random& random) {
  const bool is_thin = random.chance(0.7);
  is_square_ = !is_thin || random.chance(0.4);
  const double width =
      is_thin ? random.uniform(0.05, 0.2) : std::min(size_, 1.0) * random.uniform(0.3, 0.7);
  const double length =
      is_thin && is_square_ ? random.uniform(0.4, 1.5) : width * random.uniform(1.0, 1.5);
  irregularity_ = 0.05;
  sharpness_ = std::min(kUpright / width, 1.0);
  semi_axes_ = {length, width};
}

void Shape::draw_hole(Random& random) {
  double width = 0;
  double longer = 0;
  switch (kind_) {
    case ShapeKind::pit:
      sharpness_ = random.uniform(0.1, 0.4);
      width = std::max(0.3, size_ * random.uniform(0.6, 1.4));
      longer = random.uniform(1.0, 1.8);
      break;
    case ShapeKind::pothole:
      sharpness_ = random.uniform(2.5, 6.0);
      width = 0.15 + 0.3 * std::sqrt(random.uniform());
      // Water digs them no deeper than they are wide; a dent keeps the depth that was asked for.
      if (size_ >= 0.2) size_ = std::clamp(2 * width * random.uniform(0.35, 1.0), 0.2, 1.0);
      longer = random.uniform(1.0, 1.3);
      break;
    case ShapeKind::crater:
      width = std::max(0.4, size_ * random.uniform(1.2, 2.0));
      longer = random.uniform(1.0, 1.25);
      detail_ = random.chance(0.5) ? size_ * random.uniform(0.08, 0.3) : 0;
      irregularity_ = 0.1;
      break;
    case ShapeKind::ditch:
      width = random.uniform(0.15, 0.6);
      longer = random.uniform(0.75, 3.0) / width;
      sharpness_ = random.uniform(0.3, 0.8);
      bend_ = random.chance(0.4) ? 0 : random.uniform(-0.08, 0.08);
      end_ =
          std::min(width * (random.chance(0.5) ? random.uniform(0.3, 0.6) : random.uniform(1, 2)),
                   kLongestEnd * longer * width);
      break;
    default:
      width = std::max(0.3, size_ * random.uniform(0.8, 1.6));
      longer = random.uniform(1.0, 1.5);
  }
  if (kind_ != ShapeKind::ditch) width = std::min(width, kWidestHole);
  semi_axes_ = {width * longer, width};
}

void Shape::draw_outline(Random& random) {
  struct Wave {
    double amplitude, phase;
  };
  std::array<Wave, 4> waves{};
  double total = 0;
  for (Wave& wave : waves) {
    wave = {random.uniform(), random.uniform(0, 2 * std::numbers::pi)};
    total += wave.amplitude;
  }
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kDirections;
    outline_[i] = 1;
    for (std::size_t k = 0; k < waves.size(); ++k) {
      const double turns = static_cast<double>(k + 2);
      outline_[i] +=
          irregularity_ * waves[k].amplitude / total * std::cos(turns * angle + waves[k].phase);
    }
    if (is_square_) outline_[i] *= rounded_square(angle);
  }
}

double Shape::steepest_slope() const {
  constexpr int kSteps = 100;
  const double step = reach_ / kSteps;
  double steepest = 0;
  for (int i = -kSteps; i <= kSteps; ++i) {
    for (int j = -kSteps; j <= kSteps; ++j) {
      const Eigen::Vector2d point(i * step, j * step);
      const double here = height(point);
      const double dx = height(point + Eigen::Vector2d(step, 0)) - here;
      const double dy = height(point + Eigen::Vector2d(0, step)) - here;
      steepest = std::max(steepest, std::hypot(dx, dy) / step);
    }
  }
  return steepest;
}

}  // namespace scree
