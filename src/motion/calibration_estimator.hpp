#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "drive_windows.hpp"
#include "scree/motion/calibration.hpp"

namespace scree {

/// Estimates from a drive, or from most of it, without their deviations.
class CalibrationEstimator {
public:
  /// NaN where the drive does not show it.
  using Values = std::array<double, kCalibrated>;
  static constexpr std::size_t kParts = 10;         ///< of the drive, alike in length
  static constexpr std::size_t kLeastWindows = 20;  ///< that tell enough

  /// Keeps references.
  CalibrationEstimator(const DriveRecord& drive, const Settings& set);

  std::size_t windows() const { return windows_.size(); }
  /// @param without a part that is left out
  Values estimate(std::optional<std::size_t> without) const;

private:
  struct Ground {
    std::int64_t t_ns = 0;
    GroundPlane plane;
  };
  using Windows = std::vector<DriveWindow>;

  void estimate_lidar(const Windows& windows, const std::vector<Ground>& ground,
                      Values& values) const;
  void estimate_imu(const Windows& windows, Values& values) const;
  /// By lidar and IMU, a column a window. @param delay of the IMU's times, seconds
  std::pair<Eigen::Matrix3Xd, Eigen::Matrix3Xd> turns_of(const Windows& windows,
                                                         double delay) const;
  struct Rolled;
  Rolled rolled(const Windows& windows, const Eigen::Matrix3d& lidar, const Eigen::Vector3d& arm,
                double delay) const;
  void estimate_wheel(const Windows& windows, Values& values) const;

  const DriveRecord& drive_;
  const Settings& set_;
  Windows windows_;
  std::vector<Ground> ground_;
};

}  // namespace scree
