#include "simulator/visibility.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace scree {

void Visibility::add(std::span<const SimulatedShot> shots) {
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (shots[i].range <= 0 || shots[i].feature == 0) continue;
    Hits& hits = hits_[shots[i].feature];
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
    hits.shots = 0;
    hits.lasers = 0;
  }
}

std::vector<int> Visibility::seen() const {
  std::vector<int> found;
  for (const int id : obstacle_ids(terrain_)) {
    if (hits_[static_cast<std::size_t>(id)].seen) found.push_back(id);
  }
  return found;
}

std::vector<int> Visibility::not_seen() const {
  std::vector<int> found = small_ids(terrain_);
  for (const int id : obstacle_ids(terrain_)) {
    if (!hits_[static_cast<std::size_t>(id)].seen) found.push_back(id);
  }
  return found;
}

bool Visibility::is_known(const TerrainFeature& feature) const {
  constexpr int kLeastShots = 80;
  constexpr int kLeastSweeps = 3;
  constexpr double kDeepEnough = 0.4;
  const Hits& hits = hits_[static_cast<std::size_t>(feature.id)];
  if (hits.all_shots < kLeastShots || hits.sweeps < kLeastSweeps) return false;
  return feature.height > 0 || static_cast<double>(hits.furthest) >= kDeepEnough * -feature.height;
}

Visibility::Sight Visibility::asked_for(const Pose& base) const {
  constexpr double kFarthest = 10;
  constexpr double kAhead = 0.5;
  const Eigen::Vector3d forward = base.rotation * Eigen::Vector3d::UnitX();
  Sight sight;
  for (const TerrainFeature& feature : terrain_.features()) {
    if (!feature.kind) continue;
    const Eigen::Vector2d to = (feature.center - base.translation).head<2>();
    const bool asked = !feature.is_small && is_known(feature) && to.norm() < kFarthest &&
                       to.dot(forward.head<2>()) > kAhead;
    (asked ? sight.ids : sight.ignore).push_back(feature.id);
  }
  return sight;
}

}  // namespace scree
