#pragma once

#include <functional>
#include <vector>

#include "scree/config/settings.hpp"
#include "simulator/cloud.hpp"
#include "training/labels.hpp"

namespace scree {

/// What the clusters come from: reconstructed clouds, maps that grow on a drive, or single sweeps;
/// or the tracks of what is found in those maps.
enum class Profile : std::uint8_t { cloud, map, sweep, track };

/// Seeds from `first` on.
struct SeedRange {
  std::uint64_t first = 0;
  std::size_t count = 0;
};

/// The scenes in turn, and after them a terrain of the default kind with more features than a walk
/// would meet.
TerrainSettings varied_terrain(std::uint64_t seed);
/// 250,000 to 1,000,000 points; noise, density, ghosting and scattered points differ from seed to
/// seed.
CloudSettings varied_cloud(std::uint64_t seed);

/// Clusters that the detector finds in terrains of these seeds, with their truth. Clouds are
/// varied_cloud()s of varied_terrain()s; maps are those of the pipeline after every half second of
/// drives through all scenes, with robots as the simulator draws them, one drive in eight without
/// registration: maps that poses have smeared are to be learnt too. Sweeps are one turn at 5, 10 or
/// 20 Hz of the lidar that `settings` describes, and only obstacles that it shows well enough (see
/// Visibility) are asked for. Tracks are those after every third sweep of drives, all registered.
/// @param progress called after each seed with the number done
/// @param clusters for tracks: what judges the clusters that they follow
LabelledClusters make_data_set(Profile profile, const Settings& settings, SeedRange seeds,
                               const std::function<void(std::size_t)>& progress,
                               const Network& clusters = Network());

}  // namespace scree
