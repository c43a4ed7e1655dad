#include "simulator/cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "simulator/cloud_volumes.hpp"
#include "simulator/noise.hpp"

namespace scree {
namespace {

enum CloudStream : std::uint64_t { kPoints = 0xC10D, kDensity, kUnseen, kPasses };

/// How many points each cell of the raster gets, relative to the others; row by row.
class Density {
public:
  Density(const Terrain& terrain, const VolumePoints& volumes, const CloudSettings& settings,
          std::uint64_t seed)
      : terrain_(terrain), cells_(terrain.vertices() - 1), weight_(cells_ * cells_) {
    const GradientNoise looked_at(Random(seed, kDensity), 2 * terrain.half_size(), 6);
    for (std::size_t cell = 0; cell < weight_.size(); ++cell) {
      const double area = area_of(cell);
      const double wall = settings.wall_density + (1 - settings.wall_density) / area;
      weight_[cell] = area * wall;
      const double away = std::min(middle_of(cell).norm() / terrain.half_size(), 1.0);
      weight_[cell] *= std::pow(settings.rim_density, away);
      if (terrain.reflectivity(middle_of(cell).x(), middle_of(cell).y()) == 0) weight_[cell] = 0;
      if (settings.density_spread == 1) continue;
      const Eigen::Vector2d at = middle_of(cell);
      const double share = std::clamp(looked_at(at.x(), at.y()), -0.5, 0.5);
      weight_[cell] *= std::pow(settings.density_spread, share);
    }
    if (volumes.area() > 0) {
      for (std::size_t cell = 0; cell < weight_.size(); ++cell) {
        weight_[cell] *= volumes.light_at(middle_of(cell).x(), middle_of(cell).y());
      }
    }
    if (settings.unseen_patches) hide_patches(Random(seed, kUnseen));
    for (std::size_t cell = 1; cell < weight_.size(); ++cell) weight_[cell] += weight_[cell - 1];
  }

  /// How much of the surface is the ground's, square metres.
  double area() const {
    return weight_.back() * terrain_.settings().cell * terrain_.settings().cell;
  }
  /// Lower corner of a cell drawn at random.
  Eigen::Vector2d draw(Random& random) const {
    const double drawn = random.uniform(0, weight_.back());
    const auto found = std::upper_bound(weight_.begin(), weight_.end() - 1, drawn);
    const auto cell = static_cast<std::size_t>(found - weight_.begin());
    return {terrain_.coordinate(cell % cells_), terrain_.coordinate(cell / cells_)};
  }

private:
  /// Over the area of a level cell.
  double area_of(std::size_t cell) const {
    const double edge = terrain_.settings().cell;
    const auto at = [&](std::size_t right, std::size_t up) {
      return static_cast<double>(terrain_.vertex(cell % cells_ + right, cell / cells_ + up));
    };
    const double dx = (at(1, 0) - at(0, 0) + at(1, 1) - at(0, 1)) / (2 * edge);
    const double dy = (at(0, 1) - at(0, 0) + at(1, 1) - at(1, 0)) / (2 * edge);
    return std::sqrt(1 + dx * dx + dy * dy);
  }

  Eigen::Vector2d middle_of(std::size_t cell) const {
    const double half = terrain_.settings().cell / 2;
    return {terrain_.coordinate(cell % cells_) + half, terrain_.coordinate(cell / cells_) + half};
  }

  void hide_patches(Random random) {
    constexpr double kTall = 0.5;
    for (const TerrainFeature& feature : terrain_.features()) {
      const double angle = random.uniform(0, 2 * std::numbers::pi);
      const Eigen::Vector2d away(std::cos(angle), std::sin(angle));
      const bool chosen = random.chance(0.4);
      const double share = random.uniform(0.4, 1.2);
      if (!chosen || !feature.shape) continue;
      if (feature.height > kTall) {
        hide_behind(feature, away, share * feature.height);
      } else if (feature.shape == ShapeKind::pit || feature.shape == ShapeKind::pothole) {
        hide_floor(feature, away);
      }
    }
    for (const TerrainEdge& edge : terrain_.edges()) hide_below(edge, random);
  }

  /// What a robot did not see that stayed on its side: the ground below an edge, all of it or as
  /// far as the edge hides it.
  void hide_below(const TerrainEdge& edge, Random& random) {
    const bool chosen = random.chance(0.7);
    const bool all = random.chance(0.3);
    const double shadow = random.uniform(0.5, 3) * -edge.height();
    if (!chosen || edge.height() > 0 || edge.is_minor()) return;
    const double reach = all ? std::numeric_limits<double>::infinity() : shadow;
    for (std::size_t cell = 0; cell < weight_.size(); ++cell) {
      const double beyond = edge.beyond(middle_of(cell));
      if (beyond > 0 && beyond < reach && edge.profile(beyond) < 0) weight_[cell] = 0;
    }
  }

  /// The shadow of a rock that was passed on one side only.
  void hide_behind(const TerrainFeature& rock, const Eigen::Vector2d& away, double length) {
    const Eigen::Vector2d across(-away.y(), away.x());
    double far = 0;
    double wide = 0;
    for (const Eigen::Vector2d& corner : rock.footprint) {
      far = std::max(far, (corner - rock.center.head<2>()).dot(away));
      wide = std::max(wide, std::abs((corner - rock.center.head<2>()).dot(across)));
    }
    hide_where(rock, far + length, [&](const Eigen::Vector2d& at) {
      return at.dot(away) > 0 && at.dot(away) < far + length &&
             std::abs(at.dot(across)) < 0.8 * wide &&
             terrain_.feature_at(at.x() + rock.center.x(), at.y() + rock.center.y()) == 0;
    });
  }

  /// The side of the floor that one wall keeps from view.
  void hide_floor(const TerrainFeature& hole, const Eigen::Vector2d& away) {
    double reach = 0;
    for (const Eigen::Vector2d& corner : hole.footprint) {
      reach = std::max(reach, (corner - hole.center.head<2>()).norm());
    }
    if (reach > 1.5 * -hole.height) return;  // too wide for its walls to hide the floor
    hide_where(hole, reach, [&](const Eigen::Vector2d& at) {
      const Eigen::Vector2d place = at + hole.center.head<2>();
      return at.dot(away) > 0 && terrain_.feature_at(place.x(), place.y()) == hole.id &&
             terrain_.relief(place.x(), place.y()) < 0.6 * hole.height;
    });
  }

  /// @param is_hidden takes a place relative to the feature's centre
  template <class IsHidden>
  void hide_where(const TerrainFeature& feature, double reach, IsHidden is_hidden) {
    const double edge = terrain_.settings().cell;
    const auto index = [&](double coordinate) {
      const double place = (coordinate + terrain_.half_size()) / edge;
      return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells_ - 1)));
    };
    const double x = feature.center.x();
    const double y = feature.center.y();
    for (std::size_t row = index(y - reach); row <= index(y + reach); ++row) {
      for (std::size_t column = index(x - reach); column <= index(x + reach); ++column) {
        const std::size_t cell = row * cells_ + column;
        if (is_hidden(Eigen::Vector2d(middle_of(cell) - feature.center.head<2>()))) {
          weight_[cell] = 0;
        }
      }
    }
  }

  const Terrain& terrain_;
  std::size_t cells_;
  std::vector<double> weight_;  // in the end each the sum of all up to it
};

/// The registration error of each pass of the robot, a smooth function of the place.
class Passes {
public:
  Passes(double size, double deviation, std::uint64_t seed) : gain_(deviation / kDeviationOfNoise) {
    for (std::uint64_t i = 0; i < 3 * kPassCount; ++i) {
      fields_.emplace_back(Random(seed, kPasses + i), size, 10);
    }
  }

  Eigen::Vector3d error(std::size_t pass, double x, double y) const {
    const GradientNoise* field = &fields_[3 * pass];
    return gain_ * Eigen::Vector3d(field[0](x, y), field[1](x, y), field[2](x, y));
  }

  static constexpr std::size_t kPassCount = 3;

private:
  static constexpr double kDeviationOfNoise = 0.25;
  double gain_;
  std::vector<GradientNoise> fields_;
};

/// How far above the ground a point lies that a blade of a tuft threw back; 0 where none did.
double blade_height(const Volumes& volumes, double x, double y, Random& random) {
  const Volume* tuft = volumes.at(x, y);
  if (tuft == nullptr) return 0;
  const double away = std::hypot(x - tuft->center.x(), y - tuft->center.y()) / tuft->half.x();
  const double top = tuft->half.z() * std::sqrt(std::max(1 - away * away, 0.0));
  // Looked at from anywhere between straight above and the side.
  const double path = top * random.uniform(1, 3);
  return random.chance(std::exp(-tuft->density * path)) ? 0 : top * random.uniform();
}

}  // namespace

PointCloud reconstructed_cloud(const Terrain& terrain, const CloudSettings& settings,
                               std::uint64_t seed) {
  Random random(seed, kPoints);
  const VolumePoints volumes(terrain);
  const Density density(terrain, volumes, settings, seed);
  const double above_ground = volumes.area() / (volumes.area() + density.area());
  const Passes passes(2 * terrain.half_size(), settings.ghosting, seed);
  const double cell = terrain.settings().cell;
  const auto scattered =
      static_cast<std::size_t>(settings.scattered_share * static_cast<double>(settings.points));
  PointCloud cloud(settings.points);
  for (std::size_t i = 0; i < settings.points; ++i) {
    double bright = 0;
    std::optional<Eigen::Vector3d> off_ground;
    if (above_ground > 0 && i >= scattered && random.chance(above_ground)) {
      while (!off_ground) off_ground = volumes.draw(random, bright);
    }
    const Eigen::Vector2d corner = density.draw(random);
    const double x = corner.x() + random.uniform(0, cell);
    const double y = corner.y() + random.uniform(0, cell);
    const double reflectivity =
        (off_ground ? bright : terrain.reflectivity(x, y)) + 3 * random.normal();
    Eigen::Vector3d point = off_ground.value_or(Eigen::Vector3d(x, y, terrain.height(x, y)));
    if (i < scattered) {
      point.z() += random.uniform(-0.5, 2.0);
    } else {
      if (!off_ground) point.z() += blade_height(terrain.volumes(), x, y, random);
      point += passes.error(random.index(Passes::kPassCount), point.x(), point.y());
      for (double& coordinate : point) coordinate += settings.noise * random.normal();
    }
    const Eigen::Vector3f rounded = point.cast<float>();
    cloud.push_back(rounded.x(), rounded.y(), rounded.z(),
                    static_cast<float>(std::clamp(std::round(reflectivity), 0.0, 255.0)));
  }
  return cloud;
}

}  // namespace scree
