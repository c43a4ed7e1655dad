#include "simulator/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scree/core/pose.hpp"
#include "simulator/noise.hpp"

namespace scree {
namespace {

/// Each part of a terrain draws from a stream of its own, so that changing one leaves the others.
enum Stream : std::uint64_t { kGround = 1, kRoughness = 100, kFeatures = 200, kMaterial = 300 };

double smooth(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// The slope that 99.5 % of the raster stays under, over 0.1 m.
double steep_slope(const std::vector<float>& height, std::size_t vertices, double cell) {
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(0.1 / cell)));
  const double run = static_cast<double>(step) * cell;
  std::vector<double> slopes;
  for (std::size_t row = 0; row + step < vertices; row += 2 * step) {
    for (std::size_t column = 0; column + step < vertices; column += 2 * step) {
      const float here = height[row * vertices + column];
      const float dx = height[row * vertices + column + step] - here;
      const float dy = height[(row + step) * vertices + column] - here;
      slopes.push_back(std::hypot(static_cast<double>(dx), static_cast<double>(dy)) / run);
    }
  }
  const auto at = static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(slopes.size() - 1));
  std::nth_element(slopes.begin(), slopes.begin() + at, slopes.end());
  return slopes[static_cast<std::size_t>(at)];
}

}  // namespace

Terrain::Terrain(const TerrainSettings& settings, std::uint64_t seed)
    : settings_(settings),
      half_(settings.size / 2),
      vertices_(static_cast<std::size_t>(std::lround(settings.size / settings.cell)) + 1),
      height_(vertices_ * vertices_),
      relief_(vertices_ * vertices_),
      feature_(vertices_ * vertices_),
      reflectivity_(vertices_ * vertices_) {
  roll_ground(seed);
  roughen_ground(seed);
  place_features(seed);
  paint(seed);
  shift_origin();
}

void Terrain::roll_ground(std::uint64_t seed) {
  Random random(seed, kGround);
  const double slope =
      std::tan(radians(random.uniform(settings_.gentlest_slope_deg, settings_.steepest_slope_deg)));
  const double smoothness = random.uniform(1.1, 1.6);  // height of an octave: wavelength to this
  std::uint64_t octave = 0;
  for (const double wavelength : {18.0, 9.0, 4.5, 2.2}) {
    const GradientNoise noise(Random(seed, kGround + ++octave), settings_.size, wavelength);
    const double gain = std::pow(wavelength, smoothness);
    for (std::size_t row = 0; row < vertices_; ++row) {
      for (std::size_t column = 0; column < vertices_; ++column) {
        height_[row * vertices_ + column] +=
            static_cast<float>(gain * noise(coordinate(column), coordinate(row)));
      }
    }
  }
  if (settings_.level_radius > 0) {
    const float middle = height_[(vertices_ / 2) * (vertices_ + 1)];
    for (std::size_t row = 0; row < vertices_; ++row) {
      for (std::size_t column = 0; column < vertices_; ++column) {
        const double away = std::hypot(coordinate(column), coordinate(row));
        float& height = height_[row * vertices_ + column];
        height =
            (height - middle) * static_cast<float>(smooth((away - settings_.level_radius) / 6));
      }
    }
  }
  const auto gain = static_cast<float>(slope / steep_slope(height_, vertices_, settings_.cell));
  for (float& height : height_) height *= gain;
}

void Terrain::roughen_ground(std::uint64_t seed) {
  const double most = settings_.roughness * Random(seed, kRoughness).uniform(0.3, 1);
  std::uint64_t octave = 0;
  for (const double wavelength : {0.6, 0.25}) {
    const GradientNoise noise(Random(seed, kRoughness + ++octave), settings_.size, wavelength);
    const double gain = most * wavelength / 0.6;
    for (std::size_t row = 0; row < vertices_; ++row) {
      for (std::size_t column = 0; column < vertices_; ++column) {
        height_[row * vertices_ + column] +=
            static_cast<float>(gain * noise(coordinate(column), coordinate(row)));
      }
    }
  }
}

void Terrain::place_features(std::uint64_t seed) {
  if (settings_.clear_radius > 0) taken_.push_back({{0, 0}, settings_.clear_radius});
  const auto place_all = [&](int count, ShapeKind first, ShapeKind last, std::uint64_t stream) {
    Random random(seed, kFeatures + stream);
    const auto kinds = static_cast<std::size_t>(last) - static_cast<std::size_t>(first) + 1;
    std::vector<Shape> shapes;
    for (int i = 0; i < count; ++i) {
      const std::size_t kind = static_cast<std::size_t>(first) + random.index(kinds);
      shapes.push_back(Shape::draw(static_cast<ShapeKind>(kind), random));
    }
    // Large ones first, while there is room for them.
    std::stable_sort(shapes.begin(), shapes.end(),
                     [](const Shape& a, const Shape& b) { return a.reach() > b.reach(); });
    for (const Shape& shape : shapes) {
      constexpr int kTries = 200;
      for (int i = 0; i < kTries && !try_to_place(shape, random); ++i) continue;
    }
  };
  place_all(settings_.negative, ShapeKind::bowl, ShapeKind::ditch, 1);
  place_all(settings_.positive, ShapeKind::boulder, ShapeKind::bump, 2);
  place_all(settings_.smooth, ShapeKind::mound, ShapeKind::hollow, 3);
}

bool Terrain::try_to_place(const Shape& shape, Random& random) {
  const double within = std::min(settings_.placed_within, half_) - shape.reach();
  if (within <= 0 || features_.size() == kMostFeatures) return false;
  const Eigen::Vector2d center(random.uniform(-within, within), random.uniform(-within, within));
  for (const Disc& disc : taken_) {
    if ((disc.center - center).norm() < disc.radius + shape.reach() + settings_.gap) return false;
  }
  taken_.push_back({center, shape.reach()});
  stamp(shape, center, random);
  return true;
}

void Terrain::stamp(const Shape& shape, const Eigen::Vector2d& center, Random& random) {
  TerrainFeature feature;
  feature.id = static_cast<int>(features_.size()) + 1;
  feature.shape = shape.kind();
  if (is_positive(shape.kind())) feature.kind = ObstacleKind::positive;
  if (is_negative(shape.kind())) feature.kind = ObstacleKind::negative;
  feature.footprint = shape.footprint();
  for (Eigen::Vector2d& corner : feature.footprint) corner += center;

  const bool rocky = is_positive(shape.kind());
  const GradientNoise grain(Random(random.next()), 2 * shape.reach(),
                            std::max(0.06, 0.4 * shape.reach()));
  const auto vertex_near = [&](double at) {
    const double vertex =
        std::clamp((at + half_) / settings_.cell, 0.0, static_cast<double>(vertices_ - 1));
    return static_cast<std::size_t>(vertex);
  };
  double ground = 0;
  std::size_t inside = 0;
  for (std::size_t row = vertex_near(center.y() - shape.reach());
       row <= vertex_near(center.y() + shape.reach()); ++row) {
    for (std::size_t column = vertex_near(center.x() - shape.reach());
         column <= vertex_near(center.x() + shape.reach()); ++column) {
      const Eigen::Vector2d at = Eigen::Vector2d(coordinate(column), coordinate(row)) - center;
      const std::size_t index = row * vertices_ + column;
      double extra = shape.height(at);
      if (rocky) extra *= 1 + 0.2 * grain(at.x(), at.y());
      if (shape.inside(at)) {
        feature_[index] = static_cast<std::uint8_t>(feature.id);
        ground += static_cast<double>(height_[index]);
        ++inside;
        const bool further = is_positive(shape.kind()) || shape.kind() == ShapeKind::mound
                                 ? extra > feature.height
                                 : extra < feature.height;
        if (further) feature.height = extra;
      }
      height_[index] += static_cast<float>(extra);
      relief_[index] = static_cast<float>(extra);
    }
  }
  ground /= static_cast<double>(std::max<std::size_t>(inside, 1));
  feature.center = {center.x(), center.y(), ground + feature.height / 2};
  features_.push_back(std::move(feature));
}

void Terrain::paint(std::uint64_t seed) {
  Random random(seed, kMaterial);
  const double soil = random.uniform(15, 40);
  const GradientNoise patches(Random(seed, kMaterial + 1), settings_.size, 1.5);
  std::array<double, 256> of_feature{};
  for (const TerrainFeature& feature : features_) {
    // Rock is brighter than soil most of the time, not always; holes are cut into the same soil.
    const double rock = random.uniform(25, 80);
    of_feature[static_cast<std::size_t>(feature.id)] = is_positive(feature.shape) ? rock : soil - 3;
  }
  for (std::size_t row = 0; row < vertices_; ++row) {
    for (std::size_t column = 0; column < vertices_; ++column) {
      const std::size_t index = row * vertices_ + column;
      const double base = feature_[index] == 0 ? soil : of_feature[feature_[index]];
      const double value = base + 10 * patches(coordinate(column), coordinate(row));
      reflectivity_[index] = static_cast<std::uint8_t>(std::clamp(value, 1.0, 100.0));
    }
  }
}

void Terrain::shift_origin() {
  const float origin = height_[(vertices_ / 2) * (vertices_ + 1)];
  for (float& height : height_) height -= origin;
  for (TerrainFeature& feature : features_) feature.center.z() -= static_cast<double>(origin);
}

Terrain::Place Terrain::place(double x, double y) const {
  const double last = static_cast<double>(vertices_ - 1) - 1e-6;
  const double u = std::clamp((x + half_) / settings_.cell, 0.0, last);
  const double v = std::clamp((y + half_) / settings_.cell, 0.0, last);
  const auto column = static_cast<std::size_t>(u);
  const auto row = static_cast<std::size_t>(v);
  return {row * vertices_ + column, u - static_cast<double>(column), v - static_cast<double>(row)};
}

double Terrain::bilinear(const std::vector<float>& raster, double x, double y) const {
  const Place at = place(x, y);
  const auto corner = [&](std::size_t offset) {
    return static_cast<double>(raster[at.index + offset]);
  };
  const double low = corner(0) + at.u * (corner(1) - corner(0));
  const double high = corner(vertices_) + at.u * (corner(vertices_ + 1) - corner(vertices_));
  return low + at.v * (high - low);
}

double Terrain::height(double x, double y) const {
  return bilinear(height_, x, y);
}
double Terrain::relief(double x, double y) const {
  return bilinear(relief_, x, y);
}

Eigen::Vector3d Terrain::normal(double x, double y) const {
  const double step = settings_.cell;
  return Eigen::Vector3d(height(x - step, y) - height(x + step, y),
                         height(x, y - step) - height(x, y + step), 2 * step)
      .normalized();
}

double Terrain::reflectivity(double x, double y) const {
  return reflectivity_[place(x, y).index];
}
int Terrain::feature_at(double x, double y) const {
  return feature_[place(x, y).index];
}

std::vector<int> obstacle_ids(const Terrain& terrain) {
  std::vector<int> ids;
  for (const TerrainFeature& feature : terrain.features()) {
    if (feature.kind) ids.push_back(feature.id);
  }
  return ids;
}

}  // namespace scree
