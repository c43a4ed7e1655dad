#include "simulator/boulders.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/curves.hpp"

namespace scree {
namespace {

double about(double mean, double deviation, double least, double most, Random& random) {
  return std::clamp(mean + deviation * random.normal(), least, most);
}

}  // namespace

Boulder Boulder::draw(const Eigen::Vector2d& center, double length, Random& random) {
  Boulder boulder;
  boulder.center_ = center;
  const double yaw = random.uniform(0, kTurn);
  boulder.axis_ = {std::cos(yaw), std::sin(yaw)};
  const double width = length * about(0.76, 0.11, 0.45, 1, random);
  boulder.half_ = {length / 2, width / 2};
  boulder.height_ = std::sqrt(length * width) * about(0.45, 0.15, 0.25, 1, random);
  boulder.roundness_ = about(1.35, 0.5, 0.6, 2.4, random);
  boulder.steepness_ = about(0.5, 0.1, 0.39, 0.65, random);
  // Three waves of this amplitude have together a standard deviation of 0.08.
  constexpr double kAmplitude = 0.065;
  for (std::size_t i = 0; i < boulder.wave_.size(); ++i) {
    boulder.wave_[i] = kAmplitude * random.uniform(0.5, 1.5);
    boulder.phase_[i] = random.uniform(0, kTurn);
  }
  boulder.reach_ = length / 2 * (1 + boulder.wave_[0] + boulder.wave_[1] + boulder.wave_[2]);
  return boulder;
}

double Boulder::area() const {
  return std::numbers::pi * half_.x() * half_.y();
}

double Boulder::outline(double angle) const {
  double radius = 1;
  for (std::size_t i = 0; i < wave_.size(); ++i) {
    radius += wave_[i] * std::cos(static_cast<double>(i + 2) * angle + phase_[i]);
  }
  return radius;
}

double Boulder::top(const Eigen::Vector2d& place, double unevenness) const {
  const Eigen::Vector2d from = place - center_;
  const Eigen::Vector2d own(from.dot(axis_) / half_.x(),
                            (axis_.x() * from.y() - axis_.y() * from.x()) / half_.y());
  const double radius = own.norm() / outline(std::atan2(own.y(), own.x()));
  if (radius >= 1) return 0;
  const double dome = std::pow(1 - std::pow(radius, roundness_), steepness_);
  constexpr double kUneven = 0.14 / 0.25;
  return height_ * std::max(dome * (1 + kUneven * unevenness), 0.0);
}

Footprint Boulder::footprint() const {
  constexpr int kCorners = 16;
  Footprint corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTurn * i / kCorners;
    const Eigen::Vector2d own = outline(angle) * half_.cwiseProduct(unit_vector(angle));
    corners.emplace_back(center_ + own.x() * axis_ +
                         own.y() * Eigen::Vector2d(-axis_.y(), axis_.x()));
  }
  return corners;
}

double draw_boulder_length(double shortest, double longest, double power, Random& random) {
  const double most = 1 - std::pow(shortest / longest, power);
  return shortest * std::pow(1 - most * random.uniform(), -1 / power);
}

}  // namespace scree
