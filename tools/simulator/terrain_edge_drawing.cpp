#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/curves.hpp"
#include "simulator/terrain_edges.hpp"

namespace scree {
namespace {

constexpr std::uint64_t kEdges = 700;

/// Where a robot passes that stands at the origin.
std::vector<Eigen::Vector2d> around_origin(double radius) {
  std::vector<Eigen::Vector2d> points;
  constexpr int kPoints = 16;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = kTurn * i / kPoints;
    points.emplace_back(radius * unit_vector(angle));
  }
  return points;
}

class EdgeDrawing {
public:
  EdgeDrawing(const TerrainSettings& settings, std::uint64_t seed)
      : settings_(settings), random_(seed, kEdges), way_(settings.corridor) {
    if (way_.empty()) {
      way_ = around_origin(std::max(settings.clear_radius, 0.2 * settings.placed_within));
    }
    const Eigen::Vector2d driven = way_.back() - way_.front();
    // Every other time the robot ends its way before the edge.
    towards_ = settings.corridor.empty() || random_.chance(0.4)
                   ? random_.uniform(0, kTurn)
                   : std::atan2(driven.y(), driven.x()) + random_.uniform(-0.5, 0.5);
  }

  std::vector<TerrainEdge> draw() && {
    const EdgeCounts& edges = settings_.edges;
    add(TerrainEdgeKind::cliff, edges.cliffs);
    add(TerrainEdgeKind::kerb, edges.kerbs);
    add(TerrainEdgeKind::stairs, edges.stairs);
    add(TerrainEdgeKind::ditch, edges.ditches);
    add(TerrainEdgeKind::bank, edges.banks);
    for (int i = 0; i < edges.ploughed; ++i) plough();
    for (int i = 0; i < edges.ruts; ++i) roll();
    add(TerrainEdgeKind::pit, edges.pits);
    return std::move(edges_);
  }

private:
  /// A distance that an edge keeps from the robot's way.
  double off() {
    if (settings_.corridor.empty()) return random_.uniform(0.3, 0.4 * settings_.placed_within);
    return settings_.corridor_half_width + random_.uniform(0.2, 1.2);
  }

  TerrainEdge next(TerrainEdgeKind kind) {
    TerrainEdge edge = TerrainEdge::draw(kind, way_, off(), towards_, settings_.size, random_);
    if (kind != TerrainEdgeKind::pit) towards_ += std::numbers::pi + random_.uniform(-0.4, 0.4);
    return edge;
  }

  void add(TerrainEdgeKind kind, int count) {
    for (int i = 0; i < count; ++i) {
      TerrainEdge edge = next(kind);
      if (edge.line().size() < 4 || (kind == TerrainEdgeKind::pit && meets_another(edge))) continue;
      edges_.push_back(std::move(edge));
    }
  }

  void plough() {
    const TerrainEdge first = next(TerrainEdgeKind::furrow);
    const double apart = first.width() + random_.uniform(0.1, 0.3);
    const int count = 3 + static_cast<int>(random_.index(10));
    for (int i = 0; i < count; ++i) edges_.push_back(first.beside(i * apart));
  }

  /// The ruts of a vehicle that came through somewhere.
  void roll() {
    const Eigen::Vector2d by = way_[random_.index(way_.size())];
    const TerrainEdge left = TerrainEdge::draw(TerrainEdgeKind::rut, {&by, 1}, 0,
                                               random_.uniform(0, kTurn), settings_.size, random_);
    edges_.push_back(left.beside(random_.uniform(-3, 3)));
    edges_.push_back(edges_.back().beside(random_.uniform(1.2, 1.8)));
  }

  bool meets_another(const TerrainEdge& pit) const {
    constexpr double kPitsApart = 1;
    return std::ranges::any_of(edges_, [&](const TerrainEdge& other) {
      return std::ranges::any_of(pit.line(), [&](const Eigen::Vector2d& point) {
        const double beyond = other.beyond(point);
        return beyond > -kPitsApart &&
               (other.kind() == TerrainEdgeKind::pit || beyond < other.width() + kPitsApart);
      });
    });
  }

  const TerrainSettings& settings_;
  Random random_;
  std::vector<Eigen::Vector2d> way_;
  double towards_ = 0;
  std::vector<TerrainEdge> edges_;
};

}  // namespace

std::vector<TerrainEdge> draw_edges(const TerrainSettings& settings, std::uint64_t seed) {
  if (!settings.edges.any()) return {};
  return EdgeDrawing(settings, seed).draw();
}

}  // namespace scree
