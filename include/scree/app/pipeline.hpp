#pragma once

#include <filesystem>

#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/sweep.hpp"
#include "scree/detect/detector.hpp"

namespace scree {

/// From sweeps to obstacle lists: the daemon and `scree detect` both run this. Each sweep is taken
/// by itself, with the sensor at rest: `odom` is `base`. Memory is taken once, in make().
class Pipeline {
public:
  /// @param config_folder where a relative name of a weights file is looked for first
  static Result<Pipeline> make(const Settings& settings,
                               const std::filesystem::path& config_folder);
  /// With a detector made elsewhere, of settings.detect_sweep.
  Pipeline(const Settings& settings, Detector detector);

  /// @return the list of this sweep; valid until the next call
  const ObstacleList& process(const Sweep& sweep);

  const Detector& detector() const { return detector_; }
  /// Points of the last sweep in `base`, as the detector got them.
  const PointCloud& ground() const { return ground_; }
  /// Of the last sweep, as the detector counts; points that did not get to it are dropped ones.
  StageCounts counts() const;

private:
  void move_to_base(const Sweep& sweep);

  LidarSettings lidar_;
  PointCloud ground_;
  std::size_t dropped_ = 0;
  Detector detector_;
  ObstacleList list_;
};

/// A detector with its weights, for clouds (detect.cloud) or sweeps (detect.sweep).
Result<Detector> make_detector(const DetectSettings& settings,
                               const std::filesystem::path& config_folder);

}  // namespace scree
