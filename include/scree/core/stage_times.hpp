#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace scree {

/// The stages of the pipeline, in order. Which of them run depends on the settings.
enum class Stage : std::uint8_t {
  motion,        ///< dead reckoning, and the sweep moved to its end
  registration,  ///< with the ground seen so far
  map,
  voxel_grid,  ///< with what the robot passes under taken out
  surface,     ///< of the ground, and the heights above it
  gradient,
  suppression,  ///< or leaving out points that float alone
  supervoxels,
  clusters,
  features,
  network,
  tracking,
  grid,   ///< of what is free, occupied or unknown
  setup,  ///< whether the sensors contradict the settings
};

/// In health, in the order of Stage.
inline constexpr std::array<std::string_view, 14> kStageNames = {
    "motion",      "registration", "map",      "voxel_grid", "surface",  "gradient", "suppression",
    "supervoxels", "clusters",     "features", "network",    "tracking", "grid",     "setup"};

/// How long each stage of one list took, nanoseconds; kDidNotRun of one that did not run.
using StageTimes = std::array<std::int64_t, kStageNames.size()>;
inline constexpr std::int64_t kDidNotRun = -1;

/// Takes the times of the stages of one list, on a clock that it is given. Without one it does
/// nothing. Time between two stages counts for the later one.
class StageTimer {
public:
  /// Nanoseconds that run steadily.
  using Clock = std::int64_t (*)();

  explicit StageTimer(Clock clock = nullptr) : clock_(clock) { times_.fill(kDidNotRun); }

  /// Before the first stage.
  void start() {
    if (clock_ == nullptr) return;
    times_.fill(kDidNotRun);
    last_ns_ = clock_();
  }
  void done(Stage stage) {
    if (clock_ == nullptr) return;
    const std::int64_t now_ns = clock_();
    times_[static_cast<std::size_t>(stage)] = now_ns - last_ns_;
    last_ns_ = now_ns;
  }
  /// Since the last start().
  const StageTimes& times() const { return times_; }

private:
  Clock clock_;
  std::int64_t last_ns_ = 0;
  StageTimes times_{};
};

}  // namespace scree
