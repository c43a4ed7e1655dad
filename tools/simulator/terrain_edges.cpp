#include "simulator/terrain_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/curves.hpp"

namespace scree {
namespace {

constexpr double kApart = 0.5;            // of the line's points, metres
constexpr double kLeastHeight = 0.15;     // metres: lower steps are neither asked for nor wrong
constexpr double kSteepestGround = 30.0;  // degrees

Eigen::Vector2d normal_of(const Eigen::Vector2d& axis) {
  return {-axis.y(), axis.x()};
}

double signed_size(double size, double share_down, Random& random) {
  return random.chance(share_down) ? -size : size;
}

}  // namespace

std::string_view name_of(TerrainEdgeKind kind) {
  constexpr std::array<std::string_view, 8> kNames = {"cliff", "kerb", "bank",   "stairs",
                                                      "ditch", "rut",  "furrow", "wide_pit"};
  return kNames[static_cast<std::size_t>(kind)];
}

TerrainEdge TerrainEdge::draw(TerrainEdgeKind kind, std::span<const Eigen::Vector2d> way,
                              double off, double towards, double size, Random& random) {
  TerrainEdge edge;
  edge.kind_ = kind;
  edge.draw_profile(random);
  if (edge.is_open()) {
    edge.draw_line(way, off, towards, size, random);
  } else {
    edge.draw_ring(way, off, size, random);
  }
  edge.trace(way, size);
  return edge;
}

TerrainEdge TerrainEdge::beside(double aside) const {
  TerrainEdge edge = *this;
  edge.offset_ += aside;
  for (Eigen::Vector2d& point : edge.line_) point += aside * normal_of(axis_);
  edge.middle_ += aside * normal_of(axis_);
  return edge;
}

void TerrainEdge::draw_profile(Random& random) {
  switch (kind_) {
    case TerrainEdgeKind::cliff: {
      const double drawn = random.uniform();
      height_ = signed_size(0.2 + 2.8 * drawn * drawn, 0.65, random);
      run_ = std::max(0.04, std::abs(height_) * random.uniform(0.03, 0.25));
      width_ = std::max(0.6, run_ + 0.3);
      break;
    }
    case TerrainEdgeKind::kerb:
      height_ = signed_size(random.uniform(0.1, 0.25), 0.4, random);
      run_ = random.uniform(0.03, 0.06);
      width_ = 0.5;
      break;
    case TerrainEdgeKind::bank:
      height_ = signed_size(random.uniform(0.4, 2.5), 0.5, random);
      // A smooth step is half as steep again in its middle as on average.
      run_ = 1.5 * std::abs(height_) / std::tan(radians(random.uniform(20, 35)));
      width_ = run_;
      break;
    case TerrainEdgeKind::stairs:
      steps_ = 3 + static_cast<int>(random.index(6));
      height_ = signed_size(steps_ * random.uniform(0.15, 0.19), 0.5, random);
      run_ = steps_ * random.uniform(0.27, 0.38);
      width_ = run_;
      break;
    case TerrainEdgeKind::ditch:
      height_ = -random.uniform(0.2, 1.0);
      width_ = random.uniform(0.4, 2.4);
      run_ = width_ * random.uniform(0.15, 0.5);
      break;
    case TerrainEdgeKind::rut:
      height_ = -random.uniform(0.05, kLeastHeight);
      width_ = random.uniform(0.2, 0.4);
      run_ = width_ / 3;
      break;
    case TerrainEdgeKind::furrow:
      height_ = -random.uniform(0.06, kLeastHeight);
      width_ = random.uniform(0.3, 0.5);
      run_ = width_ / 2;
      break;
    case TerrainEdgeKind::pit:
      height_ = -random.uniform(0.4, 2.5);
      run_ = -height_ * random.uniform(0.05, 0.7);
      break;
  }
}

void TerrainEdge::draw_line(std::span<const Eigen::Vector2d> way, double off, double towards,
                            double size, Random& random) {
  const double along = towards - std::numbers::pi / 2;
  axis_ = {std::cos(along), std::sin(along)};
  constexpr double kWidest = 1.5;  // that bends: a wider strip would cross itself
  const bool may_bend = width_ < kWidest;
  if (random.chance(0.5) && may_bend) {
    bend_ = random.uniform(-0.012, 0.012);
    wave_ = random.uniform(0.1, 0.6);
    wave_rate_ = kTurn / random.uniform(8, 20);
    wave_phase_ = random.uniform(0, kTurn);
  }
  if (random.chance(0.3) && may_bend && kind_ != TerrainEdgeKind::furrow &&
      kind_ != TerrainEdgeKind::rut) {
    const double turn = std::tan(radians(random.uniform(15, 45)));
    corner_ = random.chance(0.5) ? turn : -turn;
  }
  // So wide that the strip beside it does not cross itself.
  corner_radius_ = width_ + random.uniform(0.2, 0.6);
  double middle = 0;
  for (const Eigen::Vector2d& point : way) middle += point.dot(axis_);
  middle /= static_cast<double>(std::max<std::size_t>(way.size(), 1));
  corner_at_ = middle + random.uniform(-3, 3);
  double most = -size;
  for (const Eigen::Vector2d& point : way) {
    const Eigen::Vector2d at = offset_at(point.dot(axis_));
    most = std::max(most, point.dot(normal_of(axis_)) - at.x() + off * std::hypot(1, at.y()));
  }
  offset_ = most;
}

void TerrainEdge::draw_ring(std::span<const Eigen::Vector2d> way, double off, double size,
                            Random& random) {
  radius_ = random.uniform(2.5, 7.5);
  wave_ = random.uniform(0, 0.12);
  wave_rate_ = 2 + static_cast<double>(random.index(3));
  wave_phase_ = random.uniform(0, kTurn);
  const double away = radius_ * (1 + wave_) + off;
  constexpr int kTries = 300;
  for (int i = 0; i < kTries; ++i) {
    const double angle = random.uniform(0, kTurn);
    const Eigen::Vector2d& by = way[random.index(way.size())];
    center_ = by + away * random.uniform(1, 1.2) * unit_vector(angle);
    const bool is_free = std::ranges::all_of(
        way, [&](const Eigen::Vector2d& point) { return (point - center_).norm() >= away; });
    if (is_free && center_.cwiseAbs().maxCoeff() + away < size / 2) return;
  }
  radius_ = 0;  // no room
}

double TerrainEdge::ring_radius(double angle) const {
  return radius_ * (1 + wave_ * std::cos(wave_rate_ * angle + wave_phase_));
}

Eigen::Vector2d TerrainEdge::offset_at(double u) const {
  const double from_corner = u - corner_at_;
  const double rounded = std::hypot(from_corner, corner_radius_);
  const double phase = wave_rate_ * u + wave_phase_;
  return {offset_ + bend_ * u * u + corner_ * rounded + wave_ * std::sin(phase),
          2 * bend_ * u + corner_ * from_corner / rounded + wave_ * wave_rate_ * std::cos(phase)};
}

double TerrainEdge::beyond(const Eigen::Vector2d& point) const {
  if (!is_open()) {
    const Eigen::Vector2d from = point - center_;
    return ring_radius(std::atan2(from.y(), from.x())) - from.norm();
  }
  const Eigen::Vector2d at = offset_at(point.dot(axis_));
  return (point.dot(normal_of(axis_)) - at.x()) / std::hypot(1, at.y());
}

std::size_t TerrainEdge::along(const Eigen::Vector2d& place) const {
  if (!is_open()) {
    const Eigen::Vector2d from = place - center_;
    const double turns = std::atan2(from.y(), from.x()) / kTurn;
    const auto points = static_cast<double>(line_.size());
    return static_cast<std::size_t>((turns - std::floor(turns)) * points) % line_.size();
  }
  const double from_start = (place - line_.front()).dot(axis_) / kApart;
  return static_cast<std::size_t>(
      std::clamp(from_start, 0.0, static_cast<double>(line_.size() - 1)));
}

double TerrainEdge::profile(double beyond) const {
  if (beyond <= 0) return 0;
  switch (kind_) {
    case TerrainEdgeKind::ditch:
    case TerrainEdgeKind::rut:
    case TerrainEdgeKind::furrow:
      return height_ * smooth_step(0, run_, beyond) *
             (1 - smooth_step(width_ - run_, width_, beyond));
    case TerrainEdgeKind::stairs: {
      constexpr double kRiser = 0.03;
      const double tread = run_ / steps_;
      double risen = 0;
      for (int i = 0; i < steps_; ++i) risen += smooth_step(i * tread, i * tread + kRiser, beyond);
      return height_ * risen / steps_;
    }
    default:
      return height_ * smooth_step(0, run_, beyond);
  }
}

void TerrainEdge::trace(std::span<const Eigen::Vector2d> way, double size) {
  if (!is_open()) {
    middle_ = center_;
    const auto points = static_cast<std::size_t>(std::ceil(kTurn * radius_ / kApart));
    for (std::size_t i = 0; i < points; ++i) {
      const double angle = kTurn * static_cast<double>(i) / static_cast<double>(points);
      line_.emplace_back(center_ + ring_radius(angle) * unit_vector(angle));
    }
    return;
  }
  const double half = size / 2 - kApart;
  for (double u = -size; u <= size; u += kApart) {
    const Eigen::Vector2d point = u * axis_ + offset_at(u).x() * normal_of(axis_);
    if (point.cwiseAbs().maxCoeff() < half) line_.push_back(point);
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : line_) {
    for (const Eigen::Vector2d& by : way) {
      const double away = (point - by).squaredNorm();
      if (away >= nearest) continue;
      nearest = away;
      middle_ = point + across(point) / 2;
    }
  }
}

Eigen::Vector2d TerrainEdge::across(const Eigen::Vector2d& point) const {
  const double slope = offset_at(point.dot(axis_)).y();
  return width_ * (normal_of(axis_) - slope * axis_).normalized();
}

Footprint TerrainEdge::footprint() const {
  if (!is_open()) return line_;
  Footprint strip = line_;
  for (auto point = line_.rbegin(); point != line_.rend(); ++point) {
    strip.emplace_back(*point + across(*point));
  }
  return strip;
}

bool TerrainEdge::is_ground() const {
  return kind_ == TerrainEdgeKind::bank &&
         1.5 * std::abs(height_) / run_ < std::tan(radians(kSteepestGround));
}

bool TerrainEdge::is_minor() const {
  return kind_ == TerrainEdgeKind::bank || std::abs(height_) < kLeastHeight;
}

}  // namespace scree
