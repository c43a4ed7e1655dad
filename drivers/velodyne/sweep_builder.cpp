#include "scree/drivers/velodyne/sweep_builder.hpp"

#include <algorithm>
#include <utility>

namespace scree::velodyne {
namespace {

constexpr float kFull = kFullTurn;

/// The azimuth jitters by hundredths of a degree from shot to shot; a step back by more than this
/// means that the sensor turned on past the cut. Hundredths of a degree.
constexpr float kStepBack = 500;

/// Between two cuts lies a turn, of 50 ms at least (1200 rpm). One sooner is that jitter, at the
/// cut.
constexpr std::int64_t kShortestTurnNs = 20'000'000;

}  // namespace

SweepBuilder::SweepBuilder(double cut_azimuth_deg, int parts, std::function<void(Sweep&)> on_sweep)
    : cut_azimuth_(static_cast<float>(cut_azimuth_deg * 100.0)),
      parts_(parts),
      on_sweep_(std::move(on_sweep)) {
  if (parts_ > 1) so_far_ = Sweep(kSweepCapacity);
}

bool SweepBuilder::passes_cut(float azimuth, std::int64_t shot_ns) {
  const float before = behind_cut_;
  behind_cut_ = azimuth >= cut_azimuth_ ? azimuth - cut_azimuth_ : azimuth - cut_azimuth_ + kFull;
  if (!open_) return false;
  if (shot_ns - begin_ns_ > kLongestSweepNs) {
    is_standing_ = last_shot_ns_ - begin_ns_ > kSlowestTurnNs;  // else packets are missing
    return true;
  }
  if (behind_cut_ > before - kStepBack) return false;
  // After a restart of the sensor the last cut lies ahead.
  const std::int64_t since_cut_ns = shot_ns - last_cut_ns_;
  if (was_cut_ && since_cut_ns >= 0 && since_cut_ns < kShortestTurnNs) return false;
  was_cut_ = ends_at_cut_ = true;
  last_cut_ns_ = shot_ns;
  return true;
}

void SweepBuilder::add(const Shots& shots, std::int64_t device_ns, std::int64_t to_host_ns) {
  const bool dual = shots.mode == ReturnMode::dual;
  bool counted = false;
  for (std::size_t i = 0; i < kShots; ++i) {
    const std::size_t shot = shots.firing_order[i];
    // A garbled time stamp may let packets overlap; within a sweep time never goes back.
    const std::int64_t due_ns = device_ns + shots.time_ns[shot];
    const std::int64_t shot_ns = open_ ? std::max(due_ns, last_shot_ns_) : due_ns;
    // The second return of a shot belongs to the sweep of the first.
    const bool second = dual && i % 2 == 1;
    if (!second && passes_cut(shots.azimuth[shot], shot_ns)) {
      finish();
      counted = false;
    }
    if (!open_) {
      open_ = true;
      begin_ns_ = shot_ns;
      part_ = part_at(behind_cut_);
    } else if (!second && ends_part()) {
      hand_out_part();
    }
    last_shot_ns_ = shot_ns;
    to_host_ns_ = to_host_ns;
    const float range = shots.range[shot], reflectivity = shots.reflectivity[shot];
    const Eigen::Vector3f at(shots.x[shot], shots.y[shot], shots.z[shot]);
    const auto since_begin_ns = static_cast<std::int32_t>(shot_ns - begin_ns_);
    if (range == 0.0F) {
      if (!second) sweep_.empty.push_back({at, since_begin_ns});
      continue;
    }
    if (second) {
      const std::size_t first = shots.firing_order[i - 1];
      if (shots.range[first] == range && shots.reflectivity[first] == reflectivity) continue;
    }
    if (!sweep_.push_back(at, reflectivity, since_begin_ns, laser_of(shot))) {
      ++sweep_.dropped;
      continue;
    }
    last_return_ns_ = shot_ns;
    sweep_.packets += counted ? 0 : 1;
    counted = true;
  }
}

/// Just before the cut the azimuth may still waver from behind it.
bool SweepBuilder::ends_part() const {
  return part_at(behind_cut_) > part_ && behind_cut_ < kFull - kStepBack;
}

int SweepBuilder::part_at(float behind_cut) const {
  return static_cast<int>(behind_cut * static_cast<float>(parts_) / kFull);
}

void SweepBuilder::hand_out_part() {
  part_ = part_at(behind_cut_);
  so_far_.copy_from(sweep_);
  so_far_.ends_turn = false;
  so_far_.is_whole = begins_at_cut_;
  hand_out(so_far_);
}

void SweepBuilder::finish() {
  if (!open_) return;
  open_ = false;
  sweep_.ends_turn = true;
  sweep_.is_whole = begins_at_cut_ && ends_at_cut_;
  sweep_.is_standing = std::exchange(is_standing_, false);
  begins_at_cut_ = std::exchange(ends_at_cut_, false);
  hand_out(sweep_);
  sweep_.clear();
  ++turn_;
  started_over_ = false;
}

void SweepBuilder::start_over() {
  finish();
  started_over_ = true;
}

void SweepBuilder::hand_out(Sweep& sweep) {
  const std::int64_t end_ns = sweep.points.empty() ? last_shot_ns_ : last_return_ns_;
  sweep.shift(-static_cast<std::int32_t>(end_ns - begin_ns_));
  sweep.end_ns = end_ns + to_host_ns_;
  sweep.turn = turn_;
  sweep.started_over = started_over_;
  on_sweep_(sweep);
}

}  // namespace scree::velodyne
