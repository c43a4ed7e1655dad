#include <algorithm>
#include <cmath>

#include "simulator/noise.hpp"
#include "simulator/placement.hpp"
#include "simulator/plants.hpp"
#include "simulator/structures.hpp"
#include "simulator/terrain.hpp"

namespace scree {
namespace {

// Each part of a terrain draws from a stream of its own, so that changing one leaves the others.
constexpr std::uint64_t kFeatures = 200, kMaterial = 300, kUndercut = 600;

constexpr double kBrink = 0.5;  // metres: the ground before an edge that belongs to it

bool is_near(const TerrainEdge& edge, const Eigen::Vector2d& place, double distance) {
  if (edge.is_ground()) return false;
  const double beyond = edge.beyond(place);
  return beyond > -distance &&
         (edge.kind() == TerrainEdgeKind::pit || beyond < edge.width() + distance);
}

/// @param before number of the features that are no shapes
TerrainFeature feature_of(const PlacedShape& placed, int id, int before) {
  TerrainFeature feature;
  feature.id = id;
  if (placed.partner >= 0) feature.partner = before + placed.partner + 1;
  feature.is_small = placed.is_small;
  const ShapeKind shape = placed.shape.kind();
  feature.shape = shape;
  feature.name = name_of(shape);
  if (is_positive(shape)) feature.kind = ObstacleKind::positive;
  if (is_negative(shape)) feature.kind = ObstacleKind::negative;
  feature.footprint = placed.shape.footprint();
  for (Eigen::Vector2d& corner : feature.footprint) corner += placed.center;
  return feature;
}

}  // namespace

void Terrain::cut_edges(std::uint64_t seed) {
  edges_ = draw_edges(settings_, seed);
  for (const TerrainEdge& edge : edges_) cut(edge);
}

void Terrain::add_parts(TerrainFeature& feature, std::span<const Eigen::Vector2d> places) {
  feature.first_part = parts_.size();
  feature.parts = places.size();
  for (const Eigen::Vector2d& place : places) parts_.push_back({feature.id, place});
}

void Terrain::cut(const TerrainEdge& edge) {
  constexpr std::size_t kPointsAPart = 2;
  const bool is_hollow = edge.profile(edge.width()) == 0 || edge.kind() == TerrainEdgeKind::pit;
  TerrainFeature feature;
  feature.id = static_cast<int>(features_.size()) + 1;
  if (!edge.is_ground()) {
    std::vector<Eigen::Vector2d> places;
    for (std::size_t i = 0; i < edge.line().size(); i += kPointsAPart) {
      places.push_back(edge.line()[i]);
    }
    add_parts(feature, places);
  }
  const double brink = edge.height() < 0 ? kBrink : 0;
  for (std::size_t row = 0; row < vertices_; ++row) {
    for (std::size_t column = 0; column < vertices_; ++column) {
      const Eigen::Vector2d at(coordinate(column), coordinate(row));
      const double beyond = edge.beyond(at);
      if (beyond < -brink) continue;
      const std::size_t index = row * vertices_ + column;
      const auto extra = static_cast<float>(edge.profile(beyond));
      height_[index] += extra;
      if (edge.is_ground()) continue;
      const bool is_pit = edge.kind() == TerrainEdgeKind::pit;
      if (beyond > edge.width() && !is_pit) continue;
      if (is_hollow) relief_[index] = extra;
      part_[index] = static_cast<std::uint16_t>(feature.first_part + edge.along(at) / kPointsAPart);
    }
  }
  if (!edge.is_ground()) add_edge(edge, std::move(feature));
}

void Terrain::add_edge(const TerrainEdge& edge, TerrainFeature feature) {
  feature.name = name_of(edge.kind());
  feature.kind = edge.height() < 0 ? ObstacleKind::negative : ObstacleKind::positive;
  feature.is_small = edge.is_minor();
  feature.is_edge = true;
  feature.height = edge.height();
  feature.footprint = edge.footprint();
  const Eigen::Vector2d& at = edge.middle();
  const double ground = height(at.x(), at.y()) - edge.profile(edge.beyond(at));
  feature.center = {at.x(), at.y(), ground + edge.height() / 2};
  features_.push_back(std::move(feature));
}

void Terrain::place_features(std::uint64_t seed) {
  Random random(seed, kFeatures);
  const auto is_taken = [&](const Eigen::Vector2d& place, double distance) {
    return std::ranges::any_of(
        edges_, [&](const TerrainEdge& edge) { return is_near(edge, place, distance); });
  };
  std::vector<PlacedShape> placed = lay_out_features(settings_, seed, is_taken);
  if (placed.size() > kMostShapes) placed.resize(kMostShapes);
  if (settings_.undercut > 0) {
    Random undercut(seed, kUndercut);
    for (PlacedShape& each : placed) {
      const bool is_chosen = undercut.chance(settings_.undercut);
      if (is_chosen && is_loose(each.shape.kind())) each.shape.undercut(undercut);
    }
    underside_.assign(height_.size(), 0);
  }
  const auto before = static_cast<int>(features_.size());
  for (const PlacedShape& shape : placed) stamp(shape, before, random);
}

void Terrain::stamp(const PlacedShape& placed, int before, Random& random) {
  const Shape& shape = placed.shape;
  const Eigen::Vector2d& center = placed.center;
  TerrainFeature feature = feature_of(placed, static_cast<int>(features_.size()) + 1, before);
  add_parts(feature, {&center, 1});
  const auto part = static_cast<std::uint16_t>(feature.first_part);
  const GradientNoise grain(Random(random.next()), 2 * shape.reach(),
                            std::max(0.06, 0.4 * shape.reach()));
  const bool rises = is_positive(shape.kind()) || shape.kind() == ShapeKind::mound;
  double ground = 0;
  std::size_t inside = 0;
  for_each_vertex_near(center, shape.reach(), [&](std::size_t index, const Eigen::Vector2d& place) {
    const Eigen::Vector2d at = place - center;
    const auto ground_here = static_cast<double>(height_[index]);
    const double extra = raise(index, shape, at, grain);
    if (!shape.inside(at)) return;
    part_[index] = part;
    ground += ground_here;
    ++inside;
    feature.height = rises ? std::max(feature.height, extra) : std::min(feature.height, extra);
  });
  ground /= static_cast<double>(std::max<std::size_t>(inside, 1));
  feature.center = {center.x(), center.y(), ground + feature.height / 2};
  features_.push_back(std::move(feature));
}

double Terrain::raise(std::size_t index, const Shape& shape, const Eigen::Vector2d& at,
                      const GradientNoise& grain) {
  const bool is_rock = is_positive(shape.kind());
  const double grown = is_rock ? 1 + 0.2 * grain(at.x(), at.y()) : 1;
  const double extra = grown * shape.height(at);
  if (is_rock && !underside_.empty()) {
    underside_[index] =
        std::max(underside_[index], static_cast<float>(grown * shape.underside(at)));
  }
  height_[index] += static_cast<float>(extra);
  if (extra != 0) relief_[index] = static_cast<float>(extra);
  return extra;
}

void Terrain::paint(std::uint64_t seed) {
  Random random(seed, kMaterial);
  const double soil = random.uniform(15, 40);
  const GradientNoise patches(Random(seed, kMaterial + 1), settings_.size, 1.5);
  std::vector<double> of_feature(features_.size() + 1);
  for (const TerrainFeature& feature : features_) {
    // Rock is brighter than soil most of the time, not always; holes are cut into the same soil.
    const double rock = random.uniform(25, 80);
    of_feature[static_cast<std::size_t>(feature.id)] =
        feature.kind == ObstacleKind::positive ? rock : soil - 3;
  }
  for (std::size_t row = 0; row < vertices_; ++row) {
    for (std::size_t column = 0; column < vertices_; ++column) {
      const std::size_t index = row * vertices_ + column;
      const int feature = parts_[part_[index]].feature;
      const double base = feature == 0 ? soil : of_feature[static_cast<std::size_t>(feature)];
      const double value = base + 10 * patches(coordinate(column), coordinate(row));
      if (feature != 0 && features_[static_cast<std::size_t>(feature) - 1].is_dark) continue;
      reflectivity_[index] = static_cast<std::uint8_t>(std::clamp(value, 1.0, 100.0));
    }
  }
}

void Terrain::put_up_things(std::uint64_t seed) {
  std::vector<Volume> volumes = grow_tufts(seed);
  FreeGround ground(*this);
  for (TerrainThing& thing : draw_structures(*this, ground, seed)) {
    put_up(std::move(thing), volumes);
  }
  for (TerrainThing& thing : draw_plants(*this, ground, seed)) put_up(std::move(thing), volumes);
  for (Volume& tuft : grow_tall_grass(*this, ground, seed)) volumes.push_back(std::move(tuft));
  volumes_ = Volumes(std::move(volumes), settings_.size);
}

void Terrain::put_up(TerrainThing thing, std::vector<Volume>& volumes) {
  thing.feature.id = static_cast<int>(features_.size()) + 1;
  add_parts(thing.feature, thing.places);
  for (Volume& volume : thing.volumes) {
    if (volume.part != 0) {
      volume.part = static_cast<std::uint16_t>(volume.part - 1U + thing.feature.first_part);
    }
    volumes.push_back(volume);
  }
  features_.push_back(std::move(thing.feature));
}

}  // namespace scree
