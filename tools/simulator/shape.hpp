#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "scree/core/random.hpp"
#include "simulator/footprint.hpp"

namespace scree {

/// What stands on the ground or is dug into it.
enum class ShapeKind : std::uint8_t {
  boulder,  ///< round, steep all round
  block,    ///< tilted flat top, walls
  peak,     ///< pointed
  bump,     ///< round above and below, yet steeper than 30 degrees
  log,      ///< lying half cylinder
  ledge,    ///< long step, steep on one side or on both
  pillar,   ///< upright on all sides: a post, a trunk, a crate, a wall
  bowl,     ///< parabola
  pit,      ///< flat floor, walls
  pothole,  ///< small bowl with steep sides
  crater,   ///< wide bowl, with or without a rim thrown up around it
  ditch,    ///< long, straight or bent, its ends steep or tapering
  mound,    ///< no obstacle: smooth
  hollow    ///< no obstacle: smooth
};
inline constexpr std::size_t kShapeKinds = 14;
std::string_view name_of(ShapeKind kind);

constexpr bool is_positive(ShapeKind kind) {
  return kind <= ShapeKind::pillar;
}
constexpr bool is_negative(ShapeKind kind) {
  return kind >= ShapeKind::bowl && kind <= ShapeKind::ditch;
}

/// Whether it may lie on the ground rather than in it: Shape::undercut().
constexpr bool is_loose(ShapeKind kind) {
  return kind <= ShapeKind::log;
}

constexpr bool is_long(ShapeKind kind) {
  return kind == ShapeKind::log || kind == ShapeKind::ledge || kind == ShapeKind::ditch;
}

/// Heights or depths to draw from, metres.
struct SizeRange {
  double low, high;
};

/// Height of one feature above the ground without it, in its own axes (origin at its centre).
class Shape {
public:
  /// Draws size, proportions and outline for this kind: rocks 0.15-1.2 m high (logs and ledges up
  /// to 0.5 m, pillars 0.3-1.6 m), holes 0.2-1.0 m deep, mounds and hollows at most 8-19 degrees
  /// steep.
  /// @param size instead of the kind's own range
  static Shape draw(ShapeKind kind, Random& random, std::optional<SizeRange> size = std::nullopt);

  /// Makes a rock widest some way up and narrower below, as one that lies on the ground is, and
  /// slimmer than one that stands in it.
  /// @pre is_loose(kind())
  void undercut(Random& random);

  ShapeKind kind() const { return kind_; }
  /// Beyond this distance from the centre height() is 0, metres.
  double reach() const { return reach_; }
  /// How far beyond its footprint it changes the ground (the rim of a crater), metres.
  double margin() const;
  /// Metres, below zero in a hole; 0 outside the reach.
  double height(const Eigen::Vector2d& point) const;
  /// Up to which height there is air below it, metres; 0 where it touches the ground, and outside.
  double underside(const Eigen::Vector2d& point) const;
  /// Whether the point lies inside the outline (for a crater: inside its rim's crest).
  bool inside(const Eigen::Vector2d& point) const;
  Footprint footprint() const;

private:
  static constexpr std::size_t kDirections = 256;

  Eigen::Vector2d to_own_axes(const Eigen::Vector2d& point) const;
  void draw_size(Random& random, std::optional<SizeRange> size);
  void draw_rock(Random& random);
  void draw_ledge(Random& random);
  void draw_pillar(Random& random);
  void draw_hole(Random& random);
  /// Distance from the centre in units of the outline's, 0 at the centre and 1 on the outline; for
  /// a long shape distance from its middle line.
  double radius(const Eigen::Vector2d& own) const;
  double outline(double angle) const;
  double profile(double radius, const Eigen::Vector2d& own) const;
  double long_profile(double radius, const Eigen::Vector2d& own) const;
  void draw_outline(Random& random);
  double steepest_slope() const;

  ShapeKind kind_ = ShapeKind::boulder;
  double size_ = 0;                  ///< height or depth, metres, above zero
  Eigen::Vector2d semi_axes_{1, 1};  ///< half length, half width, metres
  double cos_yaw_ = 1, sin_yaw_ = 0;
  double irregularity_ = 0.2;
  bool is_square_ = false;  ///< seen from above, else round
  double sharpness_ = 1;    ///< of the flanks; its meaning depends on the kind
  double detail_ = 0;       ///< tilt of a block, rim of a crater, 1: ledge with a ramp on one side
  double bend_ = 0;         ///< of the middle line of a long shape, 1/metres
  double end_ = 0.05;       ///< length over which a long shape ends, metres
  double widest_ = 0;       ///< where it is widest, as a share of its height
  double contact_ = 1;      ///< radius() where it touches the ground
  double reach_ = 0;
  std::array<double, kDirections> outline_{};
};

}  // namespace scree
