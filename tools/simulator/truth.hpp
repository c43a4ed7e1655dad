#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "scree/core/pose.hpp"
#include "scree/core/result.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// What truth.json says beside the obstacles themselves; all in the terrain's frame.
struct Truth {
  struct TimedPose {
    std::int64_t t_ns;
    Pose base;
  };
  struct Sight {
    std::int64_t t_ns;
    std::vector<int> ids, ignore;
  };
  std::vector<TimedPose> poses;
  std::vector<Sight> visible;
};

/// Writes truth.json as the contract has it, lengths rounded to 0.1 mm. Fails when it cannot be
/// written.
Result<void> write_truth(const std::filesystem::path& file, const Terrain& terrain,
                         const Truth& truth);

}  // namespace scree
