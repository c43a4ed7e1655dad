#include "simulator/visibility.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace scree {
namespace {

constexpr double kAhead = 0.5;  // metres: less is no longer asked for

/// From base, in the plane: how far away, and how far ahead.
struct Away {
  double far, ahead;
  Away(const Pose& base, const Eigen::Vector2d& place) {
    const Eigen::Vector2d to = place - base.translation.head<2>();
    far = to.norm();
    ahead = to.dot((base.rotation * Eigen::Vector3d::UnitX()).head<2>());
  }
};

/// Of how many parts a feature must be known.
std::ptrdiff_t least_parts(const TerrainFeature& feature) {
  return feature.is_long() ? 2 : 1;
}

}  // namespace

void Visibility::add(std::span<const SimulatedShot> shots) {
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (shots[i].range <= 0 || shots[i].part == 0) continue;
    Hits& hits = hits_[shots[i].part];
    ++hits.shots;
    hits.lasers |= 1U << (i % velodyne::kLasers);
    hits.furthest = std::max(hits.furthest, std::abs(shots[i].relief));
  }
}

void Visibility::end_sweep() {
  constexpr int kLeastShots = 20;
  constexpr int kLeastLasers = 2;
  for (Hits& hits : hits_) {
    hits.seen |= hits.shots >= kLeastShots && std::popcount(hits.lasers) >= kLeastLasers;
    hits.all_shots += hits.shots;
    hits.sweeps += hits.shots > 0 ? 1 : 0;
    hits.last_shots = std::exchange(hits.shots, 0);
    hits.lasers = 0;
  }
}

bool Visibility::is_seen(const TerrainFeature& feature) const {
  const auto parts = std::span(hits_).subspan(feature.first_part, feature.parts);
  return std::ranges::count(parts, true, &Hits::seen) >= least_parts(feature);
}

std::vector<int> Visibility::seen() const {
  std::vector<int> found;
  for (const TerrainFeature& feature : terrain_.features()) {
    if (feature.kind && !feature.is_small && is_seen(feature)) found.push_back(feature.id);
  }
  return found;
}

std::vector<int> Visibility::not_seen() const {
  std::vector<int> found = small_ids(terrain_);
  for (const TerrainFeature& feature : terrain_.features()) {
    if (feature.kind && !feature.is_small && !is_seen(feature)) found.push_back(feature.id);
  }
  return found;
}

bool Visibility::is_known(const TerrainFeature& feature) const {
  constexpr int kLeastShots = 80;
  constexpr int kLeastSweeps = 3;
  constexpr double kDeepEnough = 0.4;
  const Hits& hits = hits_[feature.first_part];
  if (hits.all_shots < kLeastShots || hits.sweeps < kLeastSweeps) return false;
  return feature.height > 0 || static_cast<double>(hits.furthest) >= kDeepEnough * -feature.height;
}

bool Visibility::is_due(const TerrainFeature& feature, const Pose& base) const {
  constexpr double kFarthest = 10;
  constexpr double kFarthestEdge = 5;
  const auto is_where_asked = [&](const Eigen::Vector2d& place) {
    const Away away(base, place);
    return away.far < (feature.is_edge ? kFarthestEdge : kFarthest) && away.ahead > kAhead;
  };
  if (!feature.is_long()) return is_known(feature) && is_where_asked(feature.center.head<2>());
  constexpr int kLeastShots = 20;
  constexpr int kLeastSweeps = 3;
  std::ptrdiff_t due = 0;
  for (std::size_t part = feature.first_part; part < feature.first_part + feature.parts; ++part) {
    const Hits& hits = hits_[part];
    const bool is_part_known = hits.all_shots >= kLeastShots && hits.sweeps >= kLeastSweeps;
    due += is_part_known && is_where_asked(terrain_.parts()[part].place) ? 1 : 0;
  }
  return due >= least_parts(feature);
}

bool Visibility::is_due(const Mover& mover, int shots, const Pose& base, std::int64_t t_ns) const {
  constexpr double kFarthest = 8;
  constexpr int kLeastShots = 15;
  const Away away(base, place_at(mover.track, t_ns).position);
  return shots >= kLeastShots && away.far < kFarthest && away.ahead > kAhead;
}

Visibility::Sight Visibility::asked_for(const Pose& base, std::int64_t t_ns) const {
  Sight sight;
  for (const TerrainFeature& feature : terrain_.features()) {
    if (!feature.kind) continue;
    const bool asked = !feature.is_small && is_due(feature, base);
    (asked ? sight.ids : sight.ignore).push_back(feature.id);
  }
  int id = static_cast<int>(terrain_.features().size());
  std::size_t part = terrain_.parts().size();
  for (const Mover& mover : movers_) {
    const bool asked = is_due(mover, hits_[part++].last_shots, base, t_ns);
    (asked ? sight.ids : sight.ignore).push_back(++id);
  }
  return sight;
}

}  // namespace scree
