#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scree/terrain/rolling_map.hpp"
#include "scree/terrain/voxel_walk.hpp"

// What the beams of a sweep went through on their way.
namespace scree {
namespace {

/// One beam in so many is traced, others each sweep.
constexpr std::uint16_t kRayStride = 4;

}  // namespace

/// Beams without return count where they went up: below lies ground that was too dark or too far.
void RollingMap::trace_rays(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                            const Eigen::Vector3f& translation, float reach) {
  const std::size_t phase = sweep_ % kRayStride;
  for (std::size_t i = sweep.fresh_points + phase; i < sweep.points.size(); i += kRayStride) {
    const Eigen::Vector3f hit(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    trace_ray(rotation * sweep.origins[i] + translation, rotation * (hit - sweep.origins[i]),
              reach);
  }
  for (std::size_t i = sweep.fresh_empty + phase; i < sweep.empty.size(); i += kRayStride) {
    const EmptyBeam& empty = sweep.empty[i];
    const Eigen::Vector3f beam = rotation * (empty.end - empty.origin);
    if (beam.z() > 0) trace_ray(rotation * empty.origin + translation, beam, reach);
  }
}

/// Traces a beam to shortly before what it hit. What has moved away must stand clear of the hit,
/// for poses err; grass is counted nearer to it. Through grass as many beams pass below a blade as
/// above it, over a rock only above: those below count for both.
void RollingMap::trace_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& beam, float reach) {
  constexpr float kClear = 0.3F, kClearShare = 0.08F;  // before the hit: metres, and of the range
  constexpr float kGrassClear = 0.12F;                 // the same where grass is counted, metres
  constexpr float kMissRadius = 0.6F;                  // of a voxel: a beam this near misses it
  constexpr float kGrassRadius = 0.4F;                 // the same where grass is counted
  const auto voxel_size = static_cast<float>(settings_.voxel);
  const Eigen::Vector3f origin = origin_.cast<float>();
  const float miss_radius = kMissRadius * voxel_size, grass_radius = kGrassRadius * voxel_size;
  const float range = beam.norm();
  const float end = std::min(range - std::max(kClear, kClearShare * range), reach);
  const Eigen::Vector3f along = beam / range;
  free_space_.add_beams(from + origin, along, std::min(end, FreeSpace::kReach), sweep_, kRayStride);
  const float grass_end = std::min(range - kGrassClear, reach);
  const auto steps = static_cast<int>(std::ceil(grass_end * inverse_));
  const MapVoxel* last = nullptr;
  const VoxelWalk walk(from * inverse_, along);
  walk.for_each_voxel(voxels_, steps, [&](int step, const VoxelKey& key) {
    MapVoxel* const voxel = voxels_.find(key);
    if (voxel == nullptr || voxel == last) return;
    last = voxel;
    const Eigen::Vector3f to_mean = voxel->mean - from;
    const Eigen::Vector3f aside = to_mean - to_mean.dot(along) * along;  // from the beam
    const float distance = aside.norm();
    if (distance < grass_radius && aside.z() > 0) voxel->beams.passed += 2 * kRayStride;
    const bool is_clear = static_cast<float>(step) * voxel_size < end;
    const bool is_miss = distance < miss_radius && is_clear && voxel->last_sweep != sweep_;
    if (!is_miss || voxel->misses == kMostMisses) return;
    if (++voxel->misses == kMostMisses) moved_.push_back(key);
  });
}

/// Remembers beams that would have met level ground within reach, and met something farther off or
/// nothing at all.
void RollingMap::add_passing_beams(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                                   const Eigen::Vector3f& translation) {
  constexpr float kFarBelow = 1.5F;  // the robot, metres: gentle slopes do not get there
  const auto reach = static_cast<float>(settings_.search_reach);
  const std::size_t phase = sweep_ % kRayStride;
  for (std::size_t i = sweep.fresh_points + phase; i < sweep.points.size(); i += kRayStride) {
    const Eigen::Vector3f hit(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    if (hit.squaredNorm() < reach * reach || hit.z() > -kFarBelow) continue;
    add_passing_beam(rotation * sweep.origins[i] + translation,
                     rotation * (hit - sweep.origins[i]));
  }
  for (std::size_t i = sweep.fresh_empty + phase; i < sweep.empty.size(); i += kRayStride) {
    const EmptyBeam& empty = sweep.empty[i];
    add_passing_beam(rotation * empty.origin + translation, rotation * (empty.end - empty.origin));
  }
}

void RollingMap::add_passing_beam(const Eigen::Vector3f& origin, const Eigen::Vector3f& beam) {
  constexpr float kLeastSlope = 0.08F;  // downwards: level ground comes within 12 m of most robots
  const PassingBeam passing{origin, beam.normalized(), beam.norm()};
  if (passing.direction.z() > -kLeastSlope) return;
  if (passing_.size() < passing_.capacity()) {
    passing_.push_back(passing);
  } else {
    passing_[next_passing_] = passing;
    next_passing_ = (next_passing_ + 1) % passing_.capacity();
  }
}

}  // namespace scree
