#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulator/curves.hpp"
#include "simulator/placement.hpp"
#include "simulator/terrain.hpp"

namespace scree {
namespace {

enum DiggingStream : std::uint64_t { kCraters = 1100, kPonds };

/// A place's distance from the middle of an uneven circle, 1 on it.
struct Ring {
  Eigen::Vector2d center;
  double radius, wave, waves, phase;

  static Ring draw(const Eigen::Vector2d& center, double radius, double unevenness,
                   Random& random) {
    const double wave = unevenness * random.uniform();
    const auto waves = static_cast<double>(2 + random.index(3));
    return {center, radius, wave, waves, random.uniform(0, kTurn)};
  }
  double at(double angle) const { return radius * (1 + wave * std::cos(waves * angle + phase)); }
  double operator()(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d from = place - center;
    return from.norm() / at(std::atan2(from.y(), from.x()));
  }
  Footprint footprint(double grown = 1) const {
    constexpr int kCorners = 36;
    Footprint corners;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = kTurn * i / kCorners;
      corners.emplace_back(center + grown * at(angle) * unit_vector(angle));
    }
    return corners;
  }
};

}  // namespace

void Terrain::dig(std::uint64_t seed) {
  const DiggingCounts& counts = settings_.diggings;
  FreeGround ground(*this);
  constexpr int kTries = 60;
  const auto dig_one = [&](Random& random, double least, double most, double beyond, auto work) {
    for (int i = 0; i < kTries; ++i) {
      const Eigen::Vector2d at = ground.near_way(settings_.placed_within, random);
      const Ring ring = Ring::draw(at, random.uniform(least, most), 0.12, random);
      if (!ground.has_room(ring.footprint(beyond), 0.3)) continue;
      ground.take(ring.footprint(beyond));
      work(ring);
      return;
    }
  };
  Random craters(seed, kCraters);
  for (int i = 0; i < counts.rimmed_craters; ++i) {
    const double wide = craters.uniform(1.3, 1.9);  // of the rim's foot over its crest
    dig_one(craters, 0.4, 2.2, wide, [&](const Ring& ring) {
      const double depth = std::max(0.2, ring.radius * craters.uniform(0.3, 0.7));
      const double rim = craters.uniform(0.1, 0.4);
      const auto profile = [&](double r) {
        if (r >= 1) return rim * (1 - smooth_step(0, 1, (r - 1) / (wide - 1)));
        return -depth + (depth + rim) * r * r;
      };
      TerrainFeature& crater =
          reshape(ring.center, ring.footprint(), wide * 1.2 * ring.radius,
                  [&](const Eigen::Vector2d& at) { return profile(ring(at)); });
      crater.name = "rimmed_crater";
      crater.height = -depth;
      crater.center.z() -= depth / 2;
    });
  }
  Random ponds(seed, kPonds);
  for (int i = 0; i < counts.ponds; ++i) {
    dig_one(ponds, 0.8, 4, 1.3, [&](const Ring& ring) {
      fill_pond(ring.center, ring.footprint(), 1.2 * 1.3 * ring.radius,
                [&](const Eigen::Vector2d& at) { return ring(at); });
    });
  }
}

TerrainFeature& Terrain::reshape(const Eigen::Vector2d& center, Footprint footprint, double reach,
                                 const Relief& extra_at) {
  TerrainFeature feature;
  feature.id = static_cast<int>(features_.size()) + 1;
  feature.kind = ObstacleKind::negative;
  feature.center = {center.x(), center.y(), height(center.x(), center.y())};
  feature.footprint = std::move(footprint);
  add_parts(feature, {&center, 1});
  for_each_vertex_near(center, reach, [&](std::size_t index, const Eigen::Vector2d& at) {
    const auto extra = static_cast<float>(extra_at(at));
    if (extra == 0) return;
    height_[index] += extra;
    relief_[index] = extra;
    if (contains(feature.footprint, at)) {
      part_[index] = static_cast<std::uint16_t>(feature.first_part);
    }
  });
  features_.push_back(std::move(feature));
  return features_.back();
}

void Terrain::fill_pond(const Eigen::Vector2d& center, Footprint footprint, double reach,
                        const Relief& radius_at) {
  constexpr double kBank = 1.3;  // where the ground is its own again, in radii
  double level = height(center.x(), center.y());
  for (const Eigen::Vector2d& corner : footprint) {
    level = std::min(level, height(corner.x(), corner.y()));
  }
  level -= 0.05;
  const auto drop = [&](const Eigen::Vector2d& at) {
    const double share = 1 - smooth_step(0, 1, (radius_at(at) - 1) / (kBank - 1));
    return share * (level - height(at.x(), at.y()));
  };
  TerrainFeature& pond = reshape(center, std::move(footprint), reach, drop);
  pond.name = "pond";
  pond.height = level - pond.center.z();
  pond.center.z() = level;
  pond.is_small = true;
  pond.is_dark = true;
}

}  // namespace scree
