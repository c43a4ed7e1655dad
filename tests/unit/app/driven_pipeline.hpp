#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "scree/app/pipeline.hpp"
#include "terrain/rough_ground.hpp"

namespace scree {

inline constexpr double kSweep = 0.1;

inline Settings small_settings() {
  Settings settings;
  settings.lidar = test::usual_lidar();
  settings.memory.sweep_points = 1 << 13;
  settings.memory.map_voxels = 1 << 16;
  settings.detect_map.min_confidence = 0;
  return settings;
}

/// A robot on its way, with the pipeline on board.
class PipelineMap : public testing::Test {
protected:
  explicit PipelineMap(const Settings& settings = small_settings())
      : settings_(settings), pipeline_(settings, Networks()) {}

  /// @param every one of so many sweeps is processed, the last in any case
  const ObstacleList& go(int sweeps, bool speaks = true, int every = 1) {
    const ObstacleList* list = nullptr;
    for (int i = 0; i < sweeps; ++i) {
      measure(speaks);
      if ((i + 1) % every == 0 || i + 1 == sweeps) list = &pipeline_.process(sweep_);
    }
    return *list;
  }

  /// The next turn, and what IMU and encoder say of it.
  void measure(bool speaks) {
    for (int k = 10 * sweeps_; speaks && k < 10 * (sweeps_ + 1); ++k) {
      ImuSample imu = drive_.imu(0.01 * (k + 1));
      EncoderSample wheel = drive_.wheel(0.01 * (k + 1));
      imu.t_ns += shift_ns_;
      imu.started_over = std::exchange(imu_starts_over_, false);
      wheel.t_ns += shift_ns_;
      wheel.distance += wheel_before_;
      pipeline_.sensors().put(imu);
      pipeline_.sensors().put(wheel);
    }
    ++sweeps_;
    test::scan(ground_, drive_, settings_.lidar, kSweep * sweeps_, sweep_);
    sweep_.end_ns += shift_ns_;
    sweep_.turn = static_cast<std::uint64_t>(sweeps_);
    sweep_.started_over = std::exchange(lidar_starts_over_, false);
  }

  /// All is driven again, and sensed a second later.
  void drive_again() {
    shift_ns_ += test::nanoseconds(kSweep * sweeps_ + 1) - test::nanoseconds(0);
    wheel_before_ += drive_.wheel(kSweep * sweeps_).distance;
    sweeps_ = 0;
  }

  test::SimpleDrive drive_ = test::helix(1, 0.2, 0);
  test::RoughGround ground_;
  Settings settings_;
  Pipeline pipeline_;
  Sweep sweep_{1 << 13};
  std::int64_t shift_ns_ = 0;
  double wheel_before_ = 0;
  bool lidar_starts_over_ = false, imu_starts_over_ = false;  // next
  int sweeps_ = 0;
};

}  // namespace scree
