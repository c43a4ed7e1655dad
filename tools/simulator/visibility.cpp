#include "simulator/visibility.hpp"

#include <bit>

namespace scree {

void Visibility::add(std::span<const SimulatedShot> shots) {
  for (std::size_t i = 0; i < shots.size(); ++i) {
    if (shots[i].range <= 0 || shots[i].feature == 0) continue;
    Hits& hits = hits_[shots[i].feature];
    ++hits.shots;
    hits.lasers |= 1U << (i % velodyne::kLasers);
  }
}

void Visibility::end_sweep() {
  constexpr int kLeastShots = 20;
  constexpr int kLeastLasers = 2;
  for (Hits& hits : hits_) {
    hits.seen |= hits.shots >= kLeastShots && std::popcount(hits.lasers) >= kLeastLasers;
    hits.shots = 0;
    hits.lasers = 0;
  }
}

std::vector<int> Visibility::seen() const {
  return ids(true);
}
std::vector<int> Visibility::not_seen() const {
  return ids(false);
}

std::vector<int> Visibility::ids(bool seen) const {
  std::vector<int> found;
  for (const TerrainFeature& feature : terrain_.features()) {
    const bool is_seen = hits_[static_cast<std::size_t>(feature.id)].seen;
    if (feature.kind && is_seen == seen) found.push_back(feature.id);
  }
  return found;
}

}  // namespace scree
