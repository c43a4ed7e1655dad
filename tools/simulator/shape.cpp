#include "simulator/shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/curves.hpp"

namespace scree {
namespace {

double bell(double radius) {
  const double c = std::cos(std::min(radius, 1.0) * std::numbers::pi / 2);
  return c * c;
}

/// How far beyond its outline, in units of radius(), a shape changes the ground.
double spread(ShapeKind kind) {
  return kind == ShapeKind::crater ? 1.5 : 1.0;
}

}  // namespace

std::string_view name_of(ShapeKind kind) {
  constexpr std::array<std::string_view, kShapeKinds> kNamesOfShapes = {
      "boulder", "block", "peak",    "bump",   "log",   "ledge", "pillar",
      "bowl",    "pit",   "pothole", "crater", "ditch", "mound", "hollow"};
  return kNamesOfShapes[static_cast<std::size_t>(kind)];
}

double Shape::outline(double angle) const {
  const double turns = angle / (2 * std::numbers::pi) + 1;  // atan2 gives -pi..pi
  const double place = (turns - std::floor(turns)) * kDirections;
  const auto index = static_cast<std::size_t>(place);
  return std::lerp(outline_[index % kDirections], outline_[(index + 1) % kDirections],
                   place - static_cast<double>(index));
}

Eigen::Vector2d Shape::to_own_axes(const Eigen::Vector2d& point) const {
  return {cos_yaw_ * point.x() + sin_yaw_ * point.y(), cos_yaw_ * point.y() - sin_yaw_ * point.x()};
}

double Shape::radius(const Eigen::Vector2d& own) const {
  if (is_long(kind_)) {
    if (std::abs(own.x()) >= semi_axes_.x()) return spread(kind_);
    return std::abs(own.y() - bend_ * own.x() * own.x()) / semi_axes_.y();
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
    case ShapeKind::pillar:
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
    case ShapeKind::pothole:
      return std::pow(std::min(r, 1.0), sharpness_) - 1;
    case ShapeKind::log:
    case ShapeKind::ledge:
    case ShapeKind::ditch:
      return long_profile(r, own);
  }
  return 0;
}

double Shape::long_profile(double radius, const Eigen::Vector2d& own) const {
  const double end = 1 - smooth_step(semi_axes_.x() - end_, semi_axes_.x(), std::abs(own.x()));
  switch (kind_) {
    case ShapeKind::log:
      return end * std::sqrt(std::max(1 - radius * radius, 0.0));
    case ShapeKind::ledge: {
      if (detail_ <= 0) return end * (1 - smooth_step(1 - sharpness_, 1, radius));
      const double across = (own.y() - bend_ * own.x() * own.x()) / semi_axes_.y();
      return end * smooth_step(-1, sharpness_ - 1, across) *
             std::min((1 - across) / (2 - sharpness_), 1.0);
    }
    default:
      return end * (smooth_step(1 - sharpness_, 1, radius) - 1);
  }
}

double Shape::margin() const {
  return reach_ * (1 - 1 / spread(kind_));
}

double Shape::height(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d own = to_own_axes(point);
  const double r = radius(own);
  return r < spread(kind_) ? size_ * std::lerp(profile(r, own), 1.0, widest_) : 0;
}

double Shape::underside(const Eigen::Vector2d& point) const {
  const double r = radius(to_own_axes(point));
  if (r <= contact_ || r >= 1) return 0;
  const double outwards = (r - contact_) / (1 - contact_);
  return size_ * widest_ * (1 - std::sqrt(1 - outwards * outwards));
}

bool Shape::inside(const Eigen::Vector2d& point) const {
  return radius(to_own_axes(point)) < 1;
}

Footprint Shape::footprint() const {
  Footprint corners;
  constexpr int kCorners = 36;
  if (is_long(kind_)) {
    for (int i = 0; i < kCorners; ++i) {
      const int half = kCorners / 2;
      const int step = i < half ? i : kCorners - 1 - i;
      const double x = semi_axes_.x() * (2.0 * step / (half - 1) - 1);
      const double side = i < half ? -semi_axes_.y() : semi_axes_.y();
      corners.emplace_back(x, bend_ * x * x + side);
    }
  } else {
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCorners;
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

}  // namespace scree
