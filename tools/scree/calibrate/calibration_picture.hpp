#pragma once

#include "calibrate/drive_capture.hpp"
#include "draw/drawing.hpp"

namespace scree::cli {

/// A drive by the settings before and after, beside each other: the ground from the side and from
/// ahead, and the way from above, by the lidar and by IMU and wheel.
Drawing draw_calibration(const DriveCapture& drive, const Settings& before, const Settings& after);

}  // namespace scree::cli
