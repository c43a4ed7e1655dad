#include "simulator/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"

namespace scree {
namespace {

constexpr double kPi = std::numbers::pi;

double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double bell(double radius) {
  const double c = std::cos(std::min(radius, 1.0) * kPi / 2);
  return c * c;
}

/// How far beyond its outline, in units of radius(), a shape changes the ground.
double spread(ShapeKind kind) {
  return kind == ShapeKind::crater ? 1.5 : 1.0;
}

}  // namespace

std::string_view name_of(ShapeKind kind) {
  constexpr std::array<std::string_view, 10> kNamesOfShapes = {
      "boulder", "block", "peak", "bump", "bowl", "pit", "crater", "ditch", "mound", "hollow"};
  return kNamesOfShapes[static_cast<std::size_t>(kind)];
}

Shape Shape::draw(ShapeKind kind, Random& random) {
  Shape shape;
  shape.kind_ = kind;
  const double yaw = random.uniform(-kPi, kPi);
  shape.cos_yaw_ = std::cos(yaw);
  shape.sin_yaw_ = std::sin(yaw);
  double irregularity = 0.2;
  double length = 1;
  double width = 1;
  if (is_positive(kind)) {
    const double draw = random.uniform();
    shape.size_ = 0.15 + 1.05 * draw * std::sqrt(draw);  // more small rocks than large ones
    width = std::max(0.15, shape.size_ * random.uniform(0.45, 1.1));
    length = width * (random.chance(0.25) ? random.uniform(1.6, 3.0) : random.uniform(1.0, 1.5));
  } else {
    shape.size_ = random.uniform(0.2, 1.0);
  }
  switch (kind) {
    case ShapeKind::boulder:
      shape.sharpness_ = random.uniform(0.35, 0.6);
      break;
    case ShapeKind::block:
      shape.sharpness_ = random.uniform(0.12, 0.35);
      shape.detail_ = random.uniform(0, 0.35);
      break;
    case ShapeKind::peak:
      shape.sharpness_ = random.uniform(0.7, 1.1);
      break;
    case ShapeKind::bump:
      width = shape.size_ * random.uniform(1.0, 1.7);
      length = width * random.uniform(1.0, 1.4);
      break;
    case ShapeKind::bowl:
      width = std::max(0.3, shape.size_ * random.uniform(0.8, 1.6));
      length = width * random.uniform(1.0, 1.5);
      break;
    case ShapeKind::pit:
      shape.sharpness_ = random.uniform(0.1, 0.4);
      width = std::max(0.3, shape.size_ * random.uniform(0.6, 1.4));
      length = width * random.uniform(1.0, 1.8);
      break;
    case ShapeKind::crater:
      width = std::max(0.4, shape.size_ * random.uniform(1.2, 2.0));
      length = width * random.uniform(1.0, 1.25);
      shape.detail_ = shape.size_ * random.uniform(0.08, 0.3);
      irregularity = 0.1;
      break;
    case ShapeKind::ditch:
      width = random.uniform(0.25, 0.6);
      length = random.uniform(1.0, 3.0);
      shape.sharpness_ = random.uniform(0.3, 0.8);
      shape.detail_ = random.uniform(-0.08, 0.08);
      break;
    case ShapeKind::mound:
    case ShapeKind::hollow:
      width = random.uniform(0.8, 2.5);
      length = width * random.uniform(1.0, 1.6);
      irregularity = 0.1;
      break;
  }
  shape.semi_axes_ = {length, width};
  shape.draw_outline(random, irregularity);
  const double largest = *std::max_element(shape.outline_.begin(), shape.outline_.end());
  shape.reach_ = kind == ShapeKind::ditch ? std::hypot(length, width + 0.08 * length * length)
                                          : length * largest * spread(kind);
  if (!is_positive(kind) && !is_negative(kind)) {
    shape.size_ = 1;
    shape.size_ = std::tan(radians(random.uniform(8, 19))) / shape.steepest_slope();
  }
  return shape;
}

void Shape::draw_outline(Random& random, double irregularity) {
  struct Wave {
    double amplitude, phase;
  };
  std::array<Wave, 4> waves{};
  double total = 0;
  for (Wave& wave : waves) {
    wave = {random.uniform(), random.uniform(0, 2 * kPi)};
    total += wave.amplitude;
  }
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double angle = 2 * kPi * static_cast<double>(i) / kDirections;
    outline_[i] = 1;
    for (std::size_t k = 0; k < waves.size(); ++k) {
      const double turns = static_cast<double>(k + 2);
      outline_[i] +=
          irregularity * waves[k].amplitude / total * std::cos(turns * angle + waves[k].phase);
    }
  }
}

double Shape::outline(double angle) const {
  const double turns = angle / (2 * kPi) + 1;  // atan2 gives -pi..pi
  const double place = (turns - std::floor(turns)) * kDirections;
  const auto index = static_cast<std::size_t>(place);
  return std::lerp(outline_[index % kDirections], outline_[(index + 1) % kDirections],
                   place - static_cast<double>(index));
}

Eigen::Vector2d Shape::to_own_axes(const Eigen::Vector2d& point) const {
  return {cos_yaw_ * point.x() + sin_yaw_ * point.y(), cos_yaw_ * point.y() - sin_yaw_ * point.x()};
}

double Shape::radius(const Eigen::Vector2d& own) const {
  if (kind_ == ShapeKind::ditch) {
    if (std::abs(own.x()) >= semi_axes_.x()) return spread(kind_);
    return std::abs(own.y() - detail_ * own.x() * own.x()) / semi_axes_.y();
  }
  const Eigen::Vector2d unit = own.cwiseQuotient(semi_axes_);
  return unit.norm() / outline(std::atan2(unit.y(), unit.x()));
}

double Shape::profile(double radius, const Eigen::Vector2d& own) const {
  const double r = radius;
  switch (kind_) {
    case ShapeKind::boulder:
      return std::pow(std::max(1 - r * r * r, 0.0), sharpness_);
    case ShapeKind::block:
      return (1 - smooth_step(1 - sharpness_, 1, r)) * (1 + detail_ * own.x() / semi_axes_.x()) /
             (1 + detail_);
    case ShapeKind::peak:
      return std::pow(std::max(1 - r, 0.0), sharpness_);
    case ShapeKind::bump:
    case ShapeKind::mound:
      return bell(r);
    case ShapeKind::hollow:
      return -bell(r);
    case ShapeKind::bowl:
      return -std::max(1 - r * r, 0.0);
    case ShapeKind::pit:
      return smooth_step(1 - sharpness_, 1, r) - 1;
    case ShapeKind::crater: {
      const double rim = detail_ / size_;
      const double outside = (r - 1) / 0.5;
      if (r >= 1) return rim * (1 - smooth_step(0, 1, outside));
      return -1 + (1 + rim) * r * r;
    }
    case ShapeKind::ditch: {
      const double taper = std::min(semi_axes_.y() * 1.5, semi_axes_.x());
      const double end = smooth_step(semi_axes_.x() - taper, semi_axes_.x(), std::abs(own.x()));
      return (smooth_step(1 - sharpness_, 1, r) - 1) * (1 - end);
    }
  }
  return 0;
}

double Shape::height(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d own = to_own_axes(point);
  const double r = radius(own);
  return r < spread(kind_) ? size_ * profile(r, own) : 0;
}

bool Shape::inside(const Eigen::Vector2d& point) const {
  return radius(to_own_axes(point)) < 1;
}

Footprint Shape::footprint() const {
  Footprint corners;
  constexpr int kCorners = 36;
  if (kind_ == ShapeKind::ditch) {
    for (int i = 0; i < kCorners; ++i) {
      const int half = kCorners / 2;
      const int step = i < half ? i : kCorners - 1 - i;
      const double x = semi_axes_.x() * (2.0 * step / (half - 1) - 1);
      const double side = i < half ? -semi_axes_.y() : semi_axes_.y();
      corners.emplace_back(x, detail_ * x * x + side);
    }
  } else {
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * kPi * i / kCorners;
      const Eigen::Vector2d unit(std::cos(angle), std::sin(angle));
      corners.emplace_back(outline(angle) * unit.cwiseProduct(semi_axes_));
    }
  }
  for (Eigen::Vector2d& corner : corners) {
    corner = {cos_yaw_ * corner.x() - sin_yaw_ * corner.y(),
              sin_yaw_ * corner.x() + cos_yaw_ * corner.y()};
  }
  return corners;
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
