#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "scree/core/random.hpp"
#include "simulator/footprint.hpp"
#include "simulator/terrain_settings.hpp"

namespace scree {

/// How the ground changes across an edge, as seen from the robot's side.
enum class TerrainEdgeKind : std::uint8_t {
  cliff,   ///< a step of 0.2-3 m, down or up, its face nearly upright
  kerb,    ///< a sharp step of 0.1-0.25 m, down or up
  bank,    ///< a slope of 20-35 degrees, 0.4-2.5 m down or up
  stairs,  ///< three steps or more, down or up
  ditch,   ///< through the whole terrain, 0.2-1 m deep
  rut,     ///< of a wheel, 0.05-0.15 m deep
  furrow,  ///< a ploughed one beside others, 0.06-0.15 m deep
  pit      ///< closed, 5-15 m across, 0.4-2.5 m deep
};
std::string_view name_of(TerrainEdgeKind kind);

/// A line, open or closed, along which the ground steps down or up. It is open to both borders of
/// the terrain, straight, bent or with a corner, or it closes around a pit.
class TerrainEdge {
public:
  /// Draws an edge that leaves the robot's way on its near side.
  /// @param way points where the robot passes
  /// @param off least distance of the edge from them, metres
  /// @param towards direction in which an open edge lies, seen from the way, radians
  /// @param size of the terrain, metres
  static TerrainEdge draw(TerrainEdgeKind kind, std::span<const Eigen::Vector2d> way, double off,
                          double towards, double size, Random& random);
  /// The furrow or rut that runs `aside` metres beyond this one.
  TerrainEdge beside(double aside) const;

  TerrainEdgeKind kind() const { return kind_; }
  /// How much lower (below zero) or higher the ground beyond is, metres; for a ditch its depth,
  /// below zero.
  double height() const { return height_; }
  /// Signed distance from the line, above zero beyond it, metres; near a corner it is rounded.
  double beyond(const Eigen::Vector2d& point) const;
  /// What it adds to the ground at this distance beyond, metres.
  double profile(double beyond) const;
  /// Where the ground changes and shortly after: from 0 to this far beyond the line, metres.
  double width() const { return width_; }
  /// Points of the line within the terrain, half a metre apart.
  const std::vector<Eigen::Vector2d>& line() const { return line_; }
  /// Index of the point of the line that lies about beside a place.
  std::size_t along(const Eigen::Vector2d& place) const;
  /// The middle of the strip where it comes nearest to the robot's way; of a pit its centre.
  const Eigen::Vector2d& middle() const { return middle_; }
  /// The strip from the line to width() beyond it; of a pit all of it.
  Footprint footprint() const;
  /// Whether all of it is ground that a robot may drive on.
  bool is_ground() const;
  /// Too low, or hardly too steep, to be asked for: finding it is neither right nor wrong.
  bool is_minor() const;

private:
  void draw_profile(Random& random);
  void draw_line(std::span<const Eigen::Vector2d> way, double off, double towards, double size,
                 Random& random);
  void draw_ring(std::span<const Eigen::Vector2d> way, double off, double size, Random& random);
  void trace(std::span<const Eigen::Vector2d> way, double size);
  /// How far a point of an open line and its like on the strip's other border are apart.
  Eigen::Vector2d across(const Eigen::Vector2d& point) const;
  /// Offset of the line at u along it, and its slope there.
  Eigen::Vector2d offset_at(double u) const;
  double ring_radius(double angle) const;
  bool is_open() const { return kind_ != TerrainEdgeKind::pit; }

  TerrainEdgeKind kind_ = TerrainEdgeKind::cliff;
  double height_ = 0, width_ = 0.6;
  double run_ = 0.1;            ///< length over which the ground changes, metres
  int steps_ = 1;               ///< of stairs
  Eigen::Vector2d axis_{1, 0};  ///< of an open line; its normal points beyond
  double offset_ = 0, bend_ = 0, corner_ = 0, corner_at_ = 0, corner_radius_ = 1;
  double wave_ = 0, wave_rate_ = 1, wave_phase_ = 0;
  Eigen::Vector2d center_{0, 0};  ///< of a pit
  double radius_ = 0;
  std::vector<Eigen::Vector2d> line_;
  Eigen::Vector2d middle_{0, 0};
};

/// The edges of a terrain.
/// @param way points where the robot passes; empty: it stands at the origin
std::vector<TerrainEdge> draw_edges(const TerrainSettings& settings, std::uint64_t seed);

}  // namespace scree
