#pragma once

#include <functional>
#include <vector>

#include "scree/config/settings.hpp"
#include "simulator/cloud.hpp"
#include "simulator/labels.hpp"

namespace scree {

/// What the clusters come from: reconstructed clouds or single sweeps.
enum class Profile : std::uint8_t { cloud, sweep };

/// Seeds from `first` on.
struct SeedRange {
  std::uint64_t first = 0;
  std::size_t count = 0;
};

/// Clusters that the detector finds in terrains of these seeds, with their truth. Clouds have
/// 600,000 to 1,000,000 points; sweeps are one turn at 5, 10 or 20 Hz of the lidar that `settings`
/// describes, and only obstacles that it shows well enough (see Visibility) are asked for.
/// @param progress called after each seed with the number done
LabelledClusters make_data_set(Profile profile, const Settings& settings, SeedRange seeds,
                               const std::function<void(std::size_t)>& progress);

}  // namespace scree
