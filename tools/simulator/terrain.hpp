#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "scree/core/obstacle.hpp"
#include "simulator/shape.hpp"

namespace scree {

/// How a terrain is drawn. Lengths in metres.
struct TerrainSettings {
  double size = 40;               ///< edge of the square, centred on the origin
  double cell = 0.02;             ///< distance of the raster's heights
  double gentlest_slope_deg = 4;  ///< the rolling ground's steepest slope is drawn between these
  double steepest_slope_deg = 15;
  double roughness = 0.012;   ///< most height of stones and grass roots too small to matter
  int positive = 11;          ///< rocks
  int negative = 7;           ///< holes
  int smooth = 8;             ///< mounds and hollows that are no obstacles
  double placed_within = 18;  ///< features lie in the square from -this to this
  double gap = 0.6;           ///< least distance of two features' rims
  double clear_radius = 0;    ///< no feature this close to the origin, where the robot stands
  double level_radius = 0;    ///< the ground is level this far around the origin
};

/// One thing on the terrain.
struct TerrainFeature {
  int id = 0;  ///< from 1
  ShapeKind shape = ShapeKind::boulder;
  std::optional<ObstacleKind> kind;  ///< none: no obstacle
  Eigen::Vector3d center;            ///< middle of the footprint, halfway up or down
  double height = 0;                 ///< above the ground without it; below zero: depth
  Footprint footprint;
};

/// Rough ground with rocks and holes whose truth is known, as a raster of heights. World frame: z
/// up, origin at the middle of the square on the ground. The same seed gives the same terrain.
class Terrain {
public:
  /// Further ones are not placed: a vertex of the raster names its feature in one byte.
  static constexpr std::size_t kMostFeatures = 255;

  Terrain(const TerrainSettings& settings, std::uint64_t seed);

  const TerrainSettings& settings() const { return settings_; }
  const std::vector<TerrainFeature>& features() const { return features_; }
  double half_size() const { return half_; }
  bool covers(double x, double y) const { return std::abs(x) < half_ && std::abs(y) < half_; }

  /// Bilinear, metres. Outside the square the height of its edge.
  double height(double x, double y) const;
  /// What the features add to the ground there, metres.
  double relief(double x, double y) const;
  Eigen::Vector3d normal(double x, double y) const;
  /// As Velodyne calibrates it, 0..255.
  double reflectivity(double x, double y) const;
  /// Id of the feature whose footprint covers the place, 0 for none.
  int feature_at(double x, double y) const;

  /// The raster: vertices a side, and the height at one of them.
  std::size_t vertices() const { return vertices_; }
  float vertex(std::size_t column, std::size_t row) const {
    return height_[row * vertices_ + column];
  }
  double coordinate(std::size_t vertex) const {
    return static_cast<double>(vertex) * settings_.cell - half_;
  }

private:
  struct Place {
    std::size_t index;  ///< of the vertex at the lower corner
    double u, v;        ///< 0..1 within the cell
  };
  Place place(double x, double y) const;
  double bilinear(const std::vector<float>& raster, double x, double y) const;
  void roll_ground(std::uint64_t seed);
  void roughen_ground(std::uint64_t seed);
  void place_features(std::uint64_t seed);
  bool try_to_place(const Shape& shape, Random& random);
  void stamp(const Shape& shape, const Eigen::Vector2d& center, Random& random);
  void paint(std::uint64_t seed);
  void shift_origin();

  TerrainSettings settings_;
  double half_;
  std::size_t vertices_;
  std::vector<float> height_, relief_;
  std::vector<std::uint8_t> feature_, reflectivity_;
  std::vector<TerrainFeature> features_;
  struct Disc {
    Eigen::Vector2d center;
    double radius;
  };
  std::vector<Disc> taken_;
};

}  // namespace scree
