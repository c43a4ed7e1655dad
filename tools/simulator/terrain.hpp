#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scree/core/obstacle.hpp"
#include "simulator/feature_layout.hpp"
#include "simulator/shape.hpp"
#include "simulator/terrain_edges.hpp"
#include "simulator/terrain_settings.hpp"
#include "simulator/volumes.hpp"

namespace scree {

class Boulder;
class GradientNoise;
struct TerrainThing;

/// One thing on the terrain.
struct TerrainFeature {
  int id = 0;                        ///< from 1
  std::string_view name;             ///< what it is
  std::optional<ShapeKind> shape;    ///< none: it is not one of these
  std::optional<ObstacleKind> kind;  ///< none: no obstacle
  int partner = 0;                   ///< id of the obstacle 0.3-0.6 m beside it, 0 for none
  bool is_small = false;             ///< a stone or dent: finding it is neither asked for nor wrong
  bool is_dark = false;              ///< light that meets it does not come back
  bool is_edge = false;              ///< where the ground ends or steps: see TerrainEdge
  std::size_t first_part = 0;        ///< of those that it is made of
  std::size_t parts = 1;             ///< of a long one each a metre long
  bool is_long() const { return parts > 1; }
  Eigen::Vector3d center;  ///< middle of the footprint, halfway up or down
  double height = 0;       ///< above the ground without it; below zero: depth
  Footprint footprint;
};

/// A piece of a feature that is seen on its own.
struct TerrainPart {
  int feature = 0;  ///< its id
  Eigen::Vector2d place{0, 0};
};

/// Rough ground with rocks and holes whose truth is known, as a raster of heights, and tufts of
/// grass on it. World frame: z up, origin at the middle of the square on the ground. The same seed
/// gives the same terrain.
class Terrain {
public:
  /// Further shapes are not placed.
  static constexpr std::size_t kMostShapes = 255;

  Terrain(const TerrainSettings& settings, std::uint64_t seed);

  const TerrainSettings& settings() const { return settings_; }
  const std::vector<TerrainFeature>& features() const { return features_; }
  const std::vector<TerrainEdge>& edges() const { return edges_; }
  /// Of all features, numbered from 1: the first is that of no feature.
  const std::vector<TerrainPart>& parts() const { return parts_; }
  /// Grass, plants and what else stands above the ground.
  const Volumes& volumes() const { return volumes_; }
  double half_size() const { return half_; }
  bool covers(double x, double y) const { return std::abs(x) < half_ && std::abs(y) < half_; }

  /// Bilinear, metres. Outside the square the height of its edge.
  double height(double x, double y) const;
  /// What the features add to the ground there, metres.
  double relief(double x, double y) const;
  /// Up to which height above the ground there is air below a rock, metres; 0 where there is none.
  double underside(double x, double y) const {
    return underside_.empty() ? 0 : bilinear(underside_, x, y);
  }
  /// From the ground without features, metres.
  double above_ground(const Eigen::Vector3d& at) const {
    return at.z() - height(at.x(), at.y()) + relief(at.x(), at.y());
  }
  /// How far a place is from ground and rocks straight up and down, metres; below zero inside them.
  double clearance(const Eigen::Vector3d& at) const;
  Eigen::Vector3d normal(double x, double y) const;
  /// As Velodyne calibrates it, 0..255; 0 where no light comes back.
  double reflectivity(double x, double y) const;
  /// Id of the feature whose footprint covers the place, 0 for none.
  int feature_at(double x, double y) const { return parts_[part_at(x, y)].feature; }
  bool is_obstacle_at(double x, double y) const {
    const int id = feature_at(x, y);
    return id != 0 && features_[static_cast<std::size_t>(id) - 1].kind.has_value();
  }
  bool is_of_edge(std::uint16_t part) const {
    return part != 0 && features_[static_cast<std::size_t>(parts_[part].feature) - 1].is_edge;
  }
  /// Index of the part that lies there; of an edge it begins half a metre before it.
  std::uint16_t part_at(double x, double y) const;

  /// The raster: vertices a side, and the height at one of them.
  std::size_t vertices() const { return vertices_; }
  float vertex(std::size_t column, std::size_t row) const {
    return height_[row * vertices_ + column];
  }
  double coordinate(std::size_t vertex) const {
    return static_cast<double>(vertex) * settings_.cell - half_;
  }

private:
  struct RasterCell {
    std::size_t index;  ///< of the vertex at the lower corner
    double u, v;        ///< 0..1 within the cell
  };
  RasterCell raster_cell(double x, double y) const;
  double bilinear(const std::vector<float>& raster, double x, double y) const;
  void roll_ground(std::uint64_t seed);
  void roughen_ground(std::uint64_t seed);
  void add_waves(std::span<const double> wavelengths, const std::function<double(double)>& gain,
                 std::uint64_t seed, std::uint64_t stream);
  void cut_edges(std::uint64_t seed);
  void cut(const TerrainEdge& edge);
  void add_edge(const TerrainEdge& edge, TerrainFeature feature);
  void add_parts(TerrainFeature& feature, std::span<const Eigen::Vector2d> places);
  void place_features(std::uint64_t seed);
  /// @param before number of the features that are no shapes
  void stamp(const PlacedShape& placed, int before, Random& random);
  /// Raises or lowers one vertex. @param at from the middle of the shape  @return by how much
  double raise(std::size_t index, const Shape& shape, const Eigen::Vector2d& at,
               const GradientNoise& grain);
  using Relief = std::function<double(const Eigen::Vector2d&)>;
  void dig(std::uint64_t seed);
  /// Adds to the ground, and a negative feature. @param extra_at metres, what is added
  TerrainFeature& reshape(const Eigen::Vector2d& center, Footprint footprint, double reach,
                          const Relief& extra_at);
  /// @param radius_at distance from its middle, 1 on its shore
  void fill_pond(const Eigen::Vector2d& center, Footprint footprint, double reach,
                 const Relief& radius_at);
  void strew_boulders(std::uint64_t seed);
  /// Puts a boulder on the ground and among those that lie there.
  void heap(const Boulder& boulder, std::uint16_t part, const Relief& unevenness);
  /// Heights of boulders as far as others do not cover them. @param first index of their features
  void measure_boulders(std::size_t first, std::span<const Boulder> boulders);
  /// Calls visit with index and place of the vertices in a square.
  template <class Visit>
  void for_each_vertex_near(const Eigen::Vector2d& center, double reach, Visit visit) const {
    const auto near = [&](double at) {
      const double vertex =
          std::clamp((at + half_) / settings_.cell, 0.0, static_cast<double>(vertices_ - 1));
      return static_cast<std::size_t>(vertex);
    };
    for (std::size_t row = near(center.y() - reach); row <= near(center.y() + reach); ++row) {
      for (std::size_t column = near(center.x() - reach); column <= near(center.x() + reach);
           ++column) {
        visit(row * vertices_ + column, Eigen::Vector2d(coordinate(column), coordinate(row)));
      }
    }
  }
  void paint(std::uint64_t seed);
  void shift_origin();
  std::vector<Volume> grow_tufts(std::uint64_t seed) const;
  /// Plants, and what else is put onto the finished ground.
  void put_up_things(std::uint64_t seed);
  void put_up(TerrainThing thing, std::vector<Volume>& volumes);

  TerrainSettings settings_;
  double half_;
  std::size_t vertices_;
  std::vector<float> height_, relief_;
  std::vector<float> underside_;  // empty where no rock has air below it
  std::vector<std::uint16_t> part_;
  std::vector<std::uint8_t> reflectivity_;
  std::vector<TerrainEdge> edges_;
  std::vector<TerrainFeature> features_;
  std::vector<TerrainPart> parts_{1};
  Volumes volumes_;
};

/// All rocks and holes of a terrain that are asked for.
std::vector<int> obstacle_ids(const Terrain& terrain);
/// The stones and dents.
std::vector<int> small_ids(const Terrain& terrain);

}  // namespace scree
