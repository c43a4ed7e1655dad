#include "simulator/terrain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scree/core/pose.hpp"
#include "simulator/curves.hpp"
#include "simulator/noise.hpp"

namespace scree {
namespace {

// Each part of a terrain draws from a stream of its own, so that changing one leaves the others.
constexpr std::uint64_t kGround = 1, kRoughness = 100, kUnevenness = 400, kTufts = 500;

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
      part_(vertices_ * vertices_),
      reflectivity_(vertices_ * vertices_) {
  roll_ground(seed);
  roughen_ground(seed);
  cut_edges(seed);
  place_features(seed);
  dig(seed);
  strew_boulders(seed);
  paint(seed);
  shift_origin();
  put_up_things(seed);
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
        height = (height - middle) *
                 static_cast<float>(smooth_step(0, 1, (away - settings_.level_radius) / 6));
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

void Terrain::shift_origin() {
  const float origin = height_[(vertices_ / 2) * (vertices_ + 1)];
  for (float& height : height_) height -= origin;
  for (TerrainFeature& feature : features_) feature.center.z() -= static_cast<double>(origin);
}

std::vector<Volume> Terrain::grow_tufts(std::uint64_t seed) const {
  if (settings_.tuft_cover <= 0) return {};
  Random random(seed, kTufts);
  const double tallest = random.uniform(0.12, 0.45);
  const double densest = random.uniform(3, 12);
  const GradientNoise meadows(Random(seed, kTufts + 1), settings_.size, 5);
  std::vector<Volume> tufts;
  // Overlapping tufts cover less than the sum of their areas.
  const double wanted = -std::log(1 - std::min(settings_.tuft_cover, 0.9)) * 4 * half_ * half_;
  for (double covered = 0; covered < wanted;) {
    const double radius = random.uniform(0.06, 0.3);
    covered += std::numbers::pi * radius * radius;
    const double x = random.uniform(-half_, half_);
    const double y = random.uniform(-half_, half_);
    // Denser in some places: every second one stands only where the meadow is.
    if (random.chance(0.5) && meadows(x, y) < 0) continue;
    if (is_obstacle_at(x, y)) continue;
    const double tall = tallest * random.uniform(0.35, 1);
    const double most = -std::log(settings_.tuft_light) / (2 * radius);
    const double density = std::min(densest * random.uniform(0.3, 1), most);
    tufts.push_back(Volume::tuft({x, y, height(x, y)}, radius, tall, density));
  }
  return tufts;
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
std::uint16_t Terrain::part_at(double x, double y) const {
  return part_[raster_cell(x, y).index];
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
