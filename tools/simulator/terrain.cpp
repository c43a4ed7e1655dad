#include "simulator/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/noise.hpp"

namespace scree {
namespace {

/// Each part of a terrain draws from a stream of its own, so that changing one leaves the others.
enum TerrainStream : std::uint64_t {
  kGround = 1,
  kRoughness = 100,
  kFeatures = 200,
  kMaterial = 300,
  kUnevenness = 400,
  kTufts = 500,
  kUndercut = 600
};

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

TerrainFeature feature_of(const PlacedShape& placed, int id) {
  TerrainFeature feature;
  feature.id = id;
  feature.partner = placed.partner + 1;
  feature.is_small = placed.is_small;
  feature.shape = placed.shape.kind();
  if (is_positive(feature.shape)) feature.kind = ObstacleKind::positive;
  if (is_negative(feature.shape)) feature.kind = ObstacleKind::negative;
  feature.footprint = placed.shape.footprint();
  for (Eigen::Vector2d& corner : feature.footprint) corner += placed.center;
  return feature;
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
  grow_tufts(seed);
}

void Terrain::add_waves(std::span<const double> wavelengths,
                        const std::function<double(double)>& gain, std::uint64_t seed,
                        std::uint64_t stream) {
  for (const double wavelength : wavelengths) {
    const GradientNoise noise(Random(seed, ++stream), settings_.size, wavelength);
    const double height = gain(wavelength);
    for (std::size_t row = 0; row < vertices_; ++row) {
      noise.add_to_row(coordinate(0), settings_.cell, coordinate(row), height,
                       std::span(height_).subspan(row * vertices_, vertices_));
    }
  }
}

void Terrain::roll_ground(std::uint64_t seed) {
  Random random(seed, kGround);
  const double slope =
      std::tan(radians(random.uniform(settings_.gentlest_slope_deg, settings_.steepest_slope_deg)));
  const double smoothness = random.uniform(1.1, 1.6);  // height of an octave: wavelength to this
  constexpr std::array kWavelengths = {18.0, 9.0, 4.5, 2.2};
  add_waves(
      kWavelengths, [&](double w) { return std::pow(w, smoothness); }, seed, kGround);
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
  constexpr std::array kStones = {0.6, 0.25};
  add_waves(
      kStones, [&](double w) { return most * w / 0.6; }, seed, kRoughness);
  if (settings_.unevenness <= 0) return;
  // The share of each octave falls with its wavelength, or short ones would be obstacles; together
  // they have the wanted standard deviation, of which gradient noise has 0.25.
  Random random(seed, kUnevenness);
  const double smoothness = random.uniform(0.7, 1.3);
  constexpr std::array kUneven = {2.0, 1.1, 0.6, 0.3};
  double sum = 0;
  for (const double w : kUneven) sum += std::pow(w, 2 * smoothness);
  const double unit = settings_.unevenness / (0.25 * std::sqrt(sum));
  add_waves(
      kUneven, [&](double w) { return unit * std::pow(w, smoothness); }, seed, kUnevenness);
}

void Terrain::place_features(std::uint64_t seed) {
  Random random(seed, kFeatures);
  std::vector<PlacedShape> placed = lay_out_features(settings_, seed);
  if (placed.size() > kMostFeatures) placed.resize(kMostFeatures);
  if (settings_.undercut > 0) {
    Random undercut(seed, kUndercut);
    for (PlacedShape& each : placed) {
      const bool is_chosen = undercut.chance(settings_.undercut);
      if (is_chosen && is_loose(each.shape.kind())) each.shape.undercut(undercut);
    }
    underside_.assign(height_.size(), 0);
  }
  for (const PlacedShape& shape : placed) stamp(shape, random);
}

void Terrain::stamp(const PlacedShape& placed, Random& random) {
  const Shape& shape = placed.shape;
  const Eigen::Vector2d& center = placed.center;
  TerrainFeature feature = feature_of(placed, static_cast<int>(features_.size()) + 1);
  const GradientNoise grain(Random(random.next()), 2 * shape.reach(),
                            std::max(0.06, 0.4 * shape.reach()));
  const auto vertex_near = [&](double at) {
    const double vertex =
        std::clamp((at + half_) / settings_.cell, 0.0, static_cast<double>(vertices_ - 1));
    return static_cast<std::size_t>(vertex);
  };
  const bool rises = is_positive(shape.kind()) || shape.kind() == ShapeKind::mound;
  double ground = 0;
  std::size_t inside = 0;
  for (std::size_t row = vertex_near(center.y() - shape.reach());
       row <= vertex_near(center.y() + shape.reach()); ++row) {
    for (std::size_t column = vertex_near(center.x() - shape.reach());
         column <= vertex_near(center.x() + shape.reach()); ++column) {
      const Eigen::Vector2d at = Eigen::Vector2d(coordinate(column), coordinate(row)) - center;
      const std::size_t index = row * vertices_ + column;
      const auto before = static_cast<double>(height_[index]);
      const double extra = raise(index, shape, at, grain);
      if (!shape.inside(at)) continue;
      feature_[index] = static_cast<std::uint8_t>(feature.id);
      ground += before;
      ++inside;
      feature.height = rises ? std::max(feature.height, extra) : std::min(feature.height, extra);
    }
  }
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

void Terrain::grow_tufts(std::uint64_t seed) {
  if (settings_.tuft_cover <= 0) return;
  Random random(seed, kTufts);
  const double tallest = random.uniform(0.12, 0.45);
  const double densest = random.uniform(3, 12);
  const GradientNoise meadows(Random(seed, kTufts + 1), settings_.size, 5);
  std::vector<Tuft> tufts;
  // Overlapping tufts cover less than the sum of their areas.
  const double wanted = -std::log(1 - std::min(settings_.tuft_cover, 0.9)) * 4 * half_ * half_;
  for (double covered = 0; covered < wanted;) {
    Tuft tuft;
    tuft.radius = random.uniform(0.06, 0.3);
    covered += std::numbers::pi * tuft.radius * tuft.radius;
    const double x = random.uniform(-half_, half_);
    const double y = random.uniform(-half_, half_);
    // Denser in some places: every second one stands only where the meadow is.
    if (random.chance(0.5) && meadows(x, y) < 0) continue;
    if (const int id = feature_at(x, y);
        id != 0 && features_[static_cast<std::size_t>(id) - 1].kind) {
      continue;
    }
    tuft.base = {x, y, height(x, y)};
    tuft.height = tallest * random.uniform(0.35, 1);
    const double most = -std::log(settings_.tuft_light) / (2 * tuft.radius);
    tuft.density = std::min(densest * random.uniform(0.3, 1), most);
    tufts.push_back(tuft);
  }
  tufts_ = Tufts(std::move(tufts), settings_.size);
}

Terrain::RasterCell Terrain::raster_cell(double x, double y) const {
  const double last = static_cast<double>(vertices_ - 1) - 1e-6;
  const double u = std::clamp((x + half_) / settings_.cell, 0.0, last);
  const double v = std::clamp((y + half_) / settings_.cell, 0.0, last);
  const auto column = static_cast<std::size_t>(u);
  const auto row = static_cast<std::size_t>(v);
  return {row * vertices_ + column, u - static_cast<double>(column), v - static_cast<double>(row)};
}

double Terrain::bilinear(const std::vector<float>& raster, double x, double y) const {
  const RasterCell at = raster_cell(x, y);
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

double Terrain::clearance(const Eigen::Vector3d& at) const {
  const double above = at.z() - height(at.x(), at.y());
  const double air = underside(at.x(), at.y());
  if (above > 0 || air <= 0) return above;
  const double up = above_ground(at);
  return std::max(above, std::min(up, air - up));
}

Eigen::Vector3d Terrain::normal(double x, double y) const {
  const double step = settings_.cell;
  return Eigen::Vector3d(height(x - step, y) - height(x + step, y),
                         height(x, y - step) - height(x, y + step), 2 * step)
      .normalized();
}

double Terrain::reflectivity(double x, double y) const {
  return reflectivity_[raster_cell(x, y).index];
}
int Terrain::feature_at(double x, double y) const {
  return feature_[raster_cell(x, y).index];
}

namespace {

std::vector<int> ids_of(const Terrain& terrain, bool is_small) {
  std::vector<int> ids;
  for (const TerrainFeature& feature : terrain.features()) {
    if (feature.kind && feature.is_small == is_small) ids.push_back(feature.id);
  }
  return ids;
}

}  // namespace

std::vector<int> obstacle_ids(const Terrain& terrain) {
  return ids_of(terrain, false);
}
std::vector<int> small_ids(const Terrain& terrain) {
  return ids_of(terrain, true);
}

}  // namespace scree
