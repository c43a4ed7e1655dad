#include "scree/terrain/rolling_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "scree/core/floor_to_cell.hpp"

namespace scree {
namespace {

/// Beams that went through a voxel since it was hit last: it has moved away.
constexpr std::uint16_t kMostPassed = 8;

/// Of this many beams one is followed.
constexpr std::uint16_t kEvery = 4;

}  // namespace

RollingMap::RollingMap(const MapSettings& settings, std::size_t max_voxels)
    : settings_(settings),
      inverse_(static_cast<float>(1 / settings.voxel)),
      voxels_(max_voxels),
      index_(std::bit_ceil(2 * voxels_.capacity())),
      mask_(index_.capacity() - 1),
      in_block_(BlockGrid::kSlots),
      cloud_(voxels_.capacity()),
      beams_(voxels_.capacity()) {
  clear();
}

void RollingMap::clear() {
  voxels_.clear();
  index_.assign(index_.capacity(), 0);
  in_block_.assign(in_block_.capacity(), 0);
  cloud_.clear();
  beams_.clear();
  free_space_.clear();
}

RollingMap::Key RollingMap::key_of(const Eigen::Vector3f& point) const {
  return {static_cast<std::int16_t>(floor_to_cell(point.x() * inverse_)),
          static_cast<std::int16_t>(floor_to_cell(point.y() * inverse_)),
          static_cast<std::int16_t>(floor_to_cell(point.z() * inverse_))};
}

std::size_t RollingMap::first_slot(const Key& key) const {
  const auto wide = [](std::int16_t value) {
    return std::uint64_t{static_cast<std::uint16_t>(value)};
  };
  std::uint64_t word = wide(key.x) | wide(key.y) << 16U | wide(key.z) << 32U;
  word *= 0x9E3779B97F4A7C15U;
  return static_cast<std::size_t>(word >> 32U) & mask_;
}

std::size_t RollingMap::slot_of(const Key& key) const {
  std::size_t slot = first_slot(key);
  while (index_[slot] != 0 && voxels_[index_[slot] - 1].key != key) slot = (slot + 1) & mask_;
  return slot;
}

const RollingMap::Voxel* RollingMap::find(const Key& key) const {
  const std::uint32_t number = index_[slot_of(key)];
  return number == 0 ? nullptr : &voxels_[number - 1];
}

RollingMap::Voxel* RollingMap::find_or_add(const Key& key) {
  const std::size_t slot = slot_of(key);
  if (index_[slot] != 0) return &voxels_[index_[slot] - 1];
  if (voxels_.full()) return nullptr;
  Voxel voxel;
  voxel.key = key;
  voxel.slot = static_cast<std::uint32_t>(slot);
  voxels_.push_back(voxel);
  index_[slot] = static_cast<std::uint32_t>(voxels_.size());
  ++voxels_around(key);
  return &voxels_.back();
}

/// Takes a voxel out; the last one takes its place.
void RollingMap::remove(std::size_t index) {
  --voxels_around(voxels_[index].key);
  // What follows in the same run of slots moves up, so that no search ends at the gap.
  std::size_t gap = voxels_[index].slot;
  for (std::size_t slot = (gap + 1) & mask_; index_[slot] != 0; slot = (slot + 1) & mask_) {
    Voxel& other = voxels_[index_[slot] - 1];
    const std::size_t home = first_slot(other.key);
    if (((slot - home) & mask_) < ((slot - gap) & mask_)) continue;
    index_[gap] = index_[slot];
    other.slot = static_cast<std::uint32_t>(gap);
    gap = slot;
  }
  index_[gap] = 0;
  if (index + 1 != voxels_.size()) {
    voxels_[index] = voxels_.back();
    index_[voxels_[index].slot] = static_cast<std::uint32_t>(index + 1);
  }
  voxels_.resize(voxels_.size() - 1);
}

/// Keeps floats small. A whole number of voxels, and rarely: the raster of later stages stays.
void RollingMap::recentre(const Pose& pose) {
  const double step = 256 * settings_.voxel;
  const Eigen::Vector3d wanted = (pose.translation / step).array().round() * step;
  const Eigen::Vector3d offset = pose.translation - origin_;
  if (offset.cwiseAbs().maxCoeff() < step) return;
  const Eigen::Vector3d shift = wanted - origin_;
  origin_ = wanted;
  const auto cells = [&](double metres) {
    return static_cast<std::int16_t>(std::lround(metres / settings_.voxel));
  };
  index_.assign(index_.capacity(), 0);
  in_block_.assign(in_block_.capacity(), 0);
  for (std::size_t i = 0; i < voxels_.size(); ++i) {
    Voxel& voxel = voxels_[i];
    voxel.mean -= shift.cast<float>();
    voxel.key.x = static_cast<std::int16_t>(voxel.key.x - cells(shift.x()));
    voxel.key.y = static_cast<std::int16_t>(voxel.key.y - cells(shift.y()));
    voxel.key.z = static_cast<std::int16_t>(voxel.key.z - cells(shift.z()));
    const std::size_t slot = slot_of(voxel.key);
    index_[slot] = static_cast<std::uint32_t>(i + 1);
    voxel.slot = static_cast<std::uint32_t>(slot);
    ++voxels_around(voxel.key);
  }
}

void RollingMap::add(const DeskewedSweep& sweep, const Pose& pose, std::int64_t end_ns,
                     double reach_of_sweep) {
  ++sweep_;
  end_ns_ = end_ns;
  recentre(pose);
  fade_beams();
  const Eigen::Matrix3f rotation = pose.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = (pose.translation - origin_).cast<float>();
  const auto reach = static_cast<float>(std::min(settings_.reach, reach_of_sweep));
  const auto search_reach = static_cast<float>(settings_.search_reach);
  const Eigen::Vector3f shift = origin_.cast<float>();
  constexpr std::uint16_t kMost = 40;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f seen(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    if (seen.squaredNorm() > reach * reach) continue;
    const Eigen::Vector3f point = rotation * seen + translation;
    Voxel* const voxel = find_or_add(key_of(point));
    if (voxel == nullptr) {
      ++dropped_;
      continue;
    }
    if (seen.squaredNorm() <= search_reach * search_reach) free_space_.add_hit(point + shift);
    if (voxel->hits < kMost) {
      ++voxel->hits;
      voxel->grains += sweep.is_grain[i];
    }
    const float share = 1 / static_cast<float>(voxel->hits);
    voxel->mean += share * (point - voxel->mean);
    voxel->reflectivity += share * (sweep.points.reflectivity[i] - voxel->reflectivity);
    if (voxel->last_sweep != sweep_ && voxel->sweeps < kMost) ++voxel->sweeps;
    voxel->last_sweep = sweep_;
    voxel->seen_ns = end_ns;
    voxel->passed = 0;
    ++voxel->beams.ended;
    voxel->beams.scatter += sweep.scatter[i];
  }
  see_through(sweep, rotation, translation, reach);
  forget(pose);
  gather_cloud(translation);
}

/// Follows some of the beams, others each sweep. Those that came back from nothing count where they
/// went up: downwards lies ground that was too dark or too far.
void RollingMap::see_through(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                             const Eigen::Vector3f& translation, float reach) {
  for (std::size_t i = sweep_ % kEvery; i < sweep.points.size(); i += kEvery) {
    const Eigen::Vector3f hit(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    follow(rotation * sweep.origins[i] + translation, rotation * (hit - sweep.origins[i]), reach);
  }
  for (std::size_t i = sweep_ % kEvery; i < sweep.empty.size(); i += kEvery) {
    const EmptyBeam& empty = sweep.empty[i];
    const Eigen::Vector3f beam = rotation * (empty.end - empty.origin);
    if (beam.z() > 0) follow(rotation * empty.origin + translation, beam, reach);
  }
}

/// Follows a beam to shortly before what it hit. What has moved away must stand clear of the hit,
/// for poses err; grass is counted nearer to it. Through grass as many beams pass below a blade as
/// above it, over a rock only above: those below count for both.
void RollingMap::follow(const Eigen::Vector3f& from, const Eigen::Vector3f& beam, float reach) {
  constexpr float kClear = 0.3F, kClearShare = 0.08F;   // before the hit: metres, and of the range
  constexpr float kBeam = 0.6F;                         // of a voxel: this near a beam hits it
  constexpr float kFartherOn = 0.12F, kThrough = 0.4F;  // metres behind it, and of a voxel
  const auto voxel_size = static_cast<float>(settings_.voxel);
  const auto search_reach = static_cast<float>(settings_.search_reach);
  const Eigen::Vector3f shift = origin_.cast<float>();
  const float near = kBeam * voxel_size, through = kThrough * voxel_size;
  const float range = beam.norm();
  const float end = std::min(range - std::max(kClear, kClearShare * range), reach);
  const Eigen::Vector3f along = beam / range;
  for (float way = 0; way < std::min(end, search_reach); way += FreeSpace::kCell) {
    free_space_.add_misses(from + way * along + shift, sweep_, kEvery);
  }
  std::uint32_t last = 0;
  const float grass_end = std::min(range - kFartherOn, reach);
  for (float way = 0; way < grass_end; way += voxel_size) {
    const Key key = key_of(from + way * along);
    if (voxels_around(key) == 0) continue;
    const std::uint32_t number = index_[slot_of(key)];
    if (number == 0 || number == last) continue;
    last = number;
    Voxel& voxel = voxels_[number - 1];
    const Eigen::Vector3f off = voxel.mean - from;
    const Eigen::Vector3f aside = off - off.dot(along) * along;  // from the beam to the mean
    const float distance = aside.norm();
    if (distance < through && aside.z() > 0) voxel.beams.passed += 2 * kEvery;
    if (distance < near && way < end && voxel.last_sweep != sweep_) ++voxel.passed;
  }
}

Occupancy RollingMap::occupancy_at(const Eigen::Vector3d& point) const {
  const Key key = key_of((point - origin_).cast<float>());
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (find(key.beside(x, y, z)) != nullptr) return Occupancy::occupied;
      }
    }
  }
  constexpr std::uint32_t kRecent = 20;  // sweeps
  const std::uint32_t passed = free_space_.last_miss(point.cast<float>());
  return passed != 0 && sweep_ - passed < kRecent ? Occupancy::free : Occupancy::unknown;
}

/// How many beams came to a thing must not tell how long the robot has been near it.
void RollingMap::fade_beams() {
  constexpr std::int64_t kEveryNs = 10'000'000'000;
  constexpr float kKept = 0.84F;  // a half in 40 s
  if (std::abs(end_ns_ - faded_ns_) < kEveryNs) return;
  faded_ns_ = end_ns_;
  for (Voxel& voxel : voxels_) {
    voxel.beams.ended *= kKept;
    voxel.beams.passed *= kKept;
    voxel.beams.scatter *= kKept;
  }
}

void RollingMap::forget(const Pose& pose) {
  const Eigen::Vector3f here = (pose.translation - origin_).cast<float>();
  const auto reach = static_cast<float>(settings_.reach);
  const auto kept_ns = static_cast<std::int64_t>(settings_.keep_seconds * 1e9);
  constexpr std::uint32_t kJudged = 30;  // sweeps after which a point must have been confirmed
  for (std::size_t i = voxels_.size(); i-- > 0;) {
    Voxel& voxel = voxels_[i];
    const bool is_far = (voxel.mean - here).squaredNorm() > reach * reach;
    const bool is_gone = voxel.passed >= kMostPassed;
    // From the future, too, when the clock was set back.
    const bool is_old = std::abs(end_ns_ - voxel.seen_ns) > kept_ns;
    const bool is_noise = sweep_ - voxel.last_sweep == kJudged && !confirm(voxel);
    if (is_far || is_gone || is_old || is_noise) remove(i);
  }
}

/// What was found beside it need not be looked for again in each sweep.
bool RollingMap::confirm(Voxel& voxel) const {
  constexpr std::uint32_t kLasts = 5;  // sweeps
  if (!voxel.is_confirmed || (sweep_ - voxel.last_sweep) % kLasts == 0) {
    voxel.is_confirmed = has_confirmation(voxel);
  }
  return voxel.is_confirmed;
}

/// Seen by two sweeps in the voxel itself, or by three in it and next to it; what ended alone, by
/// three in the voxel: grains of dust meet by chance.
bool RollingMap::has_confirmation(const Voxel& voxel) const {
  const auto is_enough = [](const Voxel& seen) { return seen.sweeps > (seen.is_grain() ? 2 : 1); };
  if (is_enough(voxel)) return true;
  if (voxel.is_grain()) return false;
  std::uint32_t other_sweep = voxel.last_sweep;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Voxel* const near = find(voxel.key.beside(x, y, z));
        if (near == nullptr) continue;
        if (is_enough(*near)) return true;
        if (near->is_grain()) continue;
        if (near->last_sweep == voxel.last_sweep || near->last_sweep == other_sweep) continue;
        if (other_sweep != voxel.last_sweep) return true;
        other_sweep = near->last_sweep;
      }
    }
  }
  return false;
}

/// Of the beams that come to dust few end there, now here, now there, and it touches nothing solid,
/// as a blade's tip does. What many ended at is none, whatever went past it.
bool RollingMap::is_dust(const Voxel& voxel) const {
  constexpr std::uint16_t kMany = 8;
  constexpr float kSolid = 0.1F;  // share of the beams that end in a coarse cell
  if (voxel.hits >= kMany) return false;
  const Eigen::Vector3f place = voxel.mean + origin_.cast<float>();
  if (free_space_.hit_ratio(place) >= kSolid) return false;
  for (const float side : {-FreeSpace::kCell, FreeSpace::kCell}) {
    for (int axis = 0; axis < 3; ++axis) {
      const float share = free_space_.hit_ratio(place + side * Eigen::Vector3f::Unit(axis));
      if (share >= kSolid && share < 1) return false;  // a grain may be all that came to a cell
    }
  }
  return true;
}

void RollingMap::gather_cloud(const Eigen::Vector3f& here) {
  cloud_.clear();
  beams_.clear();
  const auto reach = static_cast<float>(settings_.search_reach);
  for (Voxel& voxel : voxels_) {
    const bool is_far = (voxel.mean - here).squaredNorm() > reach * reach;
    if (is_far || is_dust(voxel) || !confirm(voxel)) continue;
    cloud_.push_back(voxel.mean.x(), voxel.mean.y(), voxel.mean.z(), voxel.reflectivity);
    beams_.push_back(voxel.beams);
  }
}

}  // namespace scree
