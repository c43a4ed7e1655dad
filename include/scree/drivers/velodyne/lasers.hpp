#pragma once

#include <array>

#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// Where a laser points. Index is the laser id, which is the firing order.
struct Laser {
  double elevation_deg;  ///< above the horizon
  double correction_mm;  ///< add to z: all beams cross in front of the sensor's axis, not on it
};
using Lasers = std::array<Laser, kLasers>;

/// VLP-16 and Puck LITE (63-9243 Rev. D, table 9-1).
inline constexpr Lasers kVlp16Lasers = {{{-15, 11.2},
                                         {1, -0.7},
                                         {-13, 9.7},
                                         {3, -2.2},
                                         {-11, 8.1},
                                         {5, -3.7},
                                         {-9, 6.6},
                                         {7, -5.1},
                                         {-7, 5.1},
                                         {9, -6.6},
                                         {-5, 3.7},
                                         {11, -8.1},
                                         {-3, 2.2},
                                         {13, -9.7},
                                         {-1, 0.7},
                                         {15, -11.2}}};

/// Puck Hi-Res (63-9243 Rev. D, table 9-2). The manual prints the angles to 0.01 deg; the third
/// decimal is from VeloView's calibration file.
inline constexpr Lasers kPuckHiResLasers = {{{-10, 7.4},
                                             {0.667, -0.9},
                                             {-8.667, 6.5},
                                             {2, -1.8},
                                             {-7.333, 5.5},
                                             {3.333, -2.7},
                                             {-6, 4.6},
                                             {4.667, -3.7},
                                             {-4.667, 3.7},
                                             {6, -4.6},
                                             {-3.333, 2.7},
                                             {7.333, -5.5},
                                             {-2, 1.8},
                                             {8.667, -6.5},
                                             {-0.667, 0.9},
                                             {10, -7.4}}};

constexpr const Lasers& lasers_of(LidarModel model) {
  return model == LidarModel::puck_hires ? kPuckHiResLasers : kVlp16Lasers;
}

}  // namespace scree::velodyne
