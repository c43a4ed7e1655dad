#include "study/pairs.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace scree::cli {

void Pairs::add(const CloudWorld& world, const Comparison& comparison) {
  std::map<int, bool> is_right;
  for (const auto& asked : comparison.asked) is_right[asked.obstacle->id] = asked.is_right();
  const auto& features = world.terrain.features();
  for (const TerrainFeature& feature : features) {
    const auto one = is_right.find(feature.id);
    const auto other = is_right.find(feature.partner);
    // Each pair once; where only one names the other that one counts.
    if (one == is_right.end() || other == is_right.end()) continue;
    const auto partner = std::ranges::find(features, feature.partner, &TerrainFeature::id);
    if (partner->partner == feature.id && partner->id < feature.id) continue;
    ++all;
    parted += one->second && other->second ? 1U : 0U;
  }
}

double Pairs::share_parted() const {
  if (all == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(parted) / static_cast<double>(all);
}

}  // namespace scree::cli
