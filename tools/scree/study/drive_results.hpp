#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "scoring/scoring.hpp"
#include "simulator/scene.hpp"
#include "simulator/surface_distance.hpp"
#include "study/study.hpp"

namespace scree::cli {

/// How the same drives are taken.
enum class DriveWay : std::uint8_t {
  pipeline,        ///< as the robot takes them
  faults,          ///< the same with what draw_faults() draws
  dead_reckoning,  ///< without registration
  sweeps           ///< neither IMU nor encoder ever says anything: single sweeps
};
inline constexpr std::size_t kDriveWays = 4;
inline constexpr std::array<std::string_view, kDriveWays> kDriveWayNames = {
    "full pipeline", "with faults", "dead reckoning", "single sweeps"};

/// What came of the drives through one scene.
struct SceneResult {
  Scene scene = Scene::easy;
  std::array<Scorer, kDriveWays> scorers;  ///< empty: the drives are too short for faults
  Scorer healed;         ///< with faults, but only the lists after the last of them
  Scorer unharmed;       ///< pipeline; the lists of the same times
  Scorer large;          ///< pipeline; asked only for obstacles that a warning distance is set for
  SurfaceError surface;  ///< of the pipeline's map at the end of each drive
  SurfaceError level;    ///< the same map, laid onto the truth by roll and pitch too

  const ScoringResult& of(DriveWay way) const {
    return scorers[static_cast<std::size_t>(way)].result();
  }
};

/// Obstacles that a warning distance is set for.
inline constexpr double kWarnedHeight = 0.3;  ///< of rocks, metres
inline constexpr double kWarnedWidth = 0.8;   ///< of holes in their narrowest direction, metres

/// Drives task.seeds.count times through each scene, every drive with a seed of its own, in
/// parallel. The result does not depend on the number of processors.
std::vector<SceneResult> drive_all_scenes(const StudyTask& task);

}  // namespace scree::cli
