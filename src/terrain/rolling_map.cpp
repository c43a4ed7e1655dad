#include "scree/terrain/rolling_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace scree {
namespace {

/// The mean of a voxel follows its points; beyond so many each new one counts as much.
constexpr std::uint8_t kMaxHits = 40;
/// Beams that are remembered for having passed everything: those of about a second.
constexpr std::size_t kPassingBeams = 16384;
/// Voxels that are noted for having moved away in a sweep; others wait for prune().
constexpr std::size_t kMostMoved = 65536;

}  // namespace

RollingMap::RollingMap(const MapSettings& settings, std::size_t max_voxels)
    : settings_(settings),
      inverse_(static_cast<float>(1 / settings.voxel)),
      reach_(static_cast<float>(settings.reach)),
      voxels_(max_voxels),
      moved_(kMostMoved),
      cloud_(voxels_.capacity()),
      passing_(kPassingBeams),
      beams_(cloud_.capacity()),
      origins_(cloud_.capacity()) {}

void RollingMap::clear() {
  voxels_.clear();
  cloud_.clear();
  beams_.clear();
  origins_.clear();
  prune_end_ = 0;
  passing_.clear();
  next_passing_ = 0;
  free_space_.clear();
}

VoxelKey RollingMap::key_of(const Eigen::Vector3f& point) const {
  return VoxelKey::at(point * inverse_);
}

void RollingMap::add(const DeskewedSweep& sweep, const Pose& pose, std::int64_t end_ns,
                     double reach_of_sweep) {
  if (sweep.begins_turn) ++sweep_;
  end_ns_ = end_ns;
  recenter(pose);
  decay_beam_counts();
  const Eigen::Matrix3f rotation = pose.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = (pose.translation - origin_).cast<float>();
  const auto reach = static_cast<float>(std::min<double>(reach_, reach_of_sweep));
  add_points(sweep, rotation, translation, reach);
  trace_rays(sweep, rotation, translation, reach);
  add_passing_beams(sweep, rotation, translation);
  robot_ = translation;
  remove_moved();
  fit_reach();
  prune();
  update_cloud();
}

/// Keeps floats small. The origin moves by a whole number of voxels, so that the raster of later
/// stages stays, and rarely.
void RollingMap::recenter(const Pose& pose) {
  const double step = 256 * settings_.voxel;
  const Eigen::Vector3d offset = pose.translation - origin_;
  if (offset.cwiseAbs().maxCoeff() < step) return;
  const Eigen::Vector3d origin = (pose.translation / step).array().round() * step;
  const Eigen::Vector3d shift = origin - origin_;
  origin_ = origin;
  for (MapVoxel& voxel : voxels_) {
    voxel.mean -= shift.cast<float>();
    voxel.seen_from -= shift.cast<float>();
  }
  for (PassingBeam& beam : passing_) beam.origin -= shift.cast<float>();
  const auto voxels = [&](double metres) {
    return static_cast<int>(std::lround(metres / settings_.voxel));
  };
  voxels_.shift(-voxels(shift.x()), -voxels(shift.y()), -voxels(shift.z()), sweep_);
}

/// Counts of beams halve in 40 s: they must not tell how long the robot has been near a thing.
void RollingMap::decay_beam_counts() {
  constexpr std::int64_t kPeriodNs = 10'000'000'000;
  constexpr float kKept = 0.84F;  // 0.5^(10 s / 40 s)
  if (std::abs(end_ns_ - decayed_ns_) < kPeriodNs) return;
  decayed_ns_ = end_ns_;
  for (MapVoxel& voxel : voxels_) {
    voxel.beams.ended *= kKept;
    voxel.beams.passed *= kKept;
    voxel.beams.scatter *= kKept;
  }
}

void RollingMap::add_points(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                            const Eigen::Vector3f& translation, float reach) {
  // Shots ahead whose voxels are fetched into the cache, and whose places in the index before that.
  constexpr std::size_t kVoxelAhead = 8, kIndexAhead = 16;
  const Eigen::Vector3f origin = origin_.cast<float>();
  const std::size_t count = sweep.points.size();
  const auto point_in_base = [&](std::size_t i) {
    return Eigen::Vector3f(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
  };
  const auto key_ahead = [&](std::size_t i) {
    return key_of(rotation * point_in_base(std::min(i, count - 1)) + translation);
  };
  for (std::size_t i = sweep.fresh_points; i < count; ++i) {
    voxels_.prefetch_index(key_ahead(i + kIndexAhead));
    voxels_.prefetch_voxel(key_ahead(i + kVoxelAhead));
    const Eigen::Vector3f in_base = point_in_base(i);
    if (in_base.squaredNorm() > reach * reach) continue;
    const Eigen::Vector3f point = rotation * in_base + translation;
    if (in_base.squaredNorm() <= FreeSpace::kReach * FreeSpace::kReach) {
      free_space_.add_hit(point + origin, sweep_);
    }
    if (sweep.is_moving[i] != 0) continue;
    MapVoxel* const voxel = voxels_.find_or_add(key_of(point));
    if (voxel == nullptr) {
      ++dropped_;
      continue;
    }
    add_hit(*voxel, point, sweep, i);
    voxel->seen_from = rotation * sweep.origins[i] + translation;
  }
}

void RollingMap::add_hit(MapVoxel& voxel, const Eigen::Vector3f& point, const DeskewedSweep& sweep,
                         std::size_t index) {
  const bool was_isolated = voxel.is_isolated();
  const bool is_first = voxel.last_sweep != sweep_;
  if (voxel.hits < kMaxHits) {
    ++voxel.hits;
    voxel.isolated_hits += sweep.is_isolated[index];
  }
  const float share = 1 / static_cast<float>(voxel.hits);
  voxel.mean += share * (point - voxel.mean);
  voxel.reflectivity += share * (sweep.points.reflectivity[index] - voxel.reflectivity);
  if (is_first && voxel.sweeps < kMaxHits) ++voxel.sweeps;
  voxel.last_sweep = sweep_;
  voxel.seen_ds = tenths(end_ns_);
  voxel.misses = 0;
  ++voxel.beams.ended;
  voxel.beams.scatter += sweep.scatter[index];
  if (is_first || voxel.is_isolated() != was_isolated) voxels_.grow(voxel.key, sweep_);
}

Occupancy RollingMap::occupancy_at(const Eigen::Vector3d& point) const {
  constexpr std::uint32_t kRecent = 20;  // sweeps
  const VoxelKey key = key_of((point - origin_).cast<float>());
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (voxels_.find(key.shifted(x, y, z)) != nullptr) return Occupancy::occupied;
      }
    }
  }
  const std::uint32_t last_miss = free_space_.last_miss(point.cast<float>());
  const bool is_free = last_miss != 0 && sweep_ - last_miss < kRecent;
  return is_free ? Occupancy::free : Occupancy::unknown;
}

bool RollingMap::is_seen_through(const Eigen::Vector3d& point) const {
  return free_space_.is_seen_through(point.cast<float>(), sweep_);
}

/// Among trees the map fills up: then what is farthest off makes room, as far as obstacles are not
/// searched for there.
void RollingMap::fit_reach() {
  constexpr float kFull = 0.85F, kRoomy = 0.7F, kStep = 0.95F;
  const auto farthest = static_cast<float>(settings_.reach);
  const auto nearest = std::min(static_cast<float>(settings_.search_reach), farthest);
  const auto used = static_cast<float>(voxels_.size()) / static_cast<float>(voxels_.capacity());
  if (used > kFull) reach_ = std::max(reach_ * kStep, nearest);
  if (used < kRoomy) reach_ = std::min(reach_ / kStep, farthest);
}

void RollingMap::remove_moved() {
  for (const VoxelKey& key : moved_) {
    voxels_.erase(static_cast<std::size_t>(voxels_.find(key) - voxels_.begin()), sweep_);
  }
  moved_.clear();
}

/// Removes what is too far off, what is too old, what was never confirmed. None of it is in a
/// hurry: a part of the voxels is looked at in each sweep.
void RollingMap::prune() {
  constexpr std::uint32_t kConfirmWithin = 30;  // sweeps
  const float reach = reach_;
  const auto kept_ds = static_cast<std::int32_t>(settings_.keep_seconds * 10);
  const std::uint32_t now_ds = tenths(end_ns_);
  prune_end_ = std::min(prune_end_, voxels_.size());
  if (prune_end_ == 0) {
    prune_end_ = voxels_.size();
    prune_step_ = voxels_.size() / kPruneSweeps + 1;
  }
  const std::size_t begin = prune_end_ - std::min(prune_step_, prune_end_);
  // What takes the place of one that goes comes from the end, where all were looked at.
  for (std::size_t i = prune_end_; i-- > begin;) {
    MapVoxel& voxel = voxels_[i];
    const bool is_far = (voxel.mean - robot_).squaredNorm() > reach * reach;
    const bool has_moved = voxel.misses >= kMostMisses;
    // From the future, too, when the clock was set back.
    const bool is_old = std::abs(static_cast<std::int32_t>(now_ds - voxel.seen_ds)) > kept_ds;
    const bool is_due = sweep_ - voxel.last_sweep - kConfirmWithin < 2 * kPruneSweeps;
    if (is_far || has_moved || is_old || (is_due && !confirm(voxel))) voxels_.erase(i, sweep_);
  }
  prune_end_ = begin;
}

void RollingMap::update_cloud() {
  const auto reach = static_cast<float>(settings_.search_reach);
  ++looks_;
  cloud_.clear();
  beams_.clear();
  origins_.clear();
  for (MapVoxel& voxel : voxels_) {
    if ((voxel.mean - robot_).squaredNorm() > reach * reach) {
      voxel.was_looked_at = false;
      continue;
    }
    if (!confirm(voxel) || is_dust(voxel)) continue;
    cloud_.push_back(voxel.mean.x(), voxel.mean.y(), voxel.mean.z(), voxel.reflectivity);
    beams_.push_back(voxel.beams);
    origins_.push_back(voxel.seen_from);
  }
}

}  // namespace scree
