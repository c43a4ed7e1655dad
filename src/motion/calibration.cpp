#include "scree/motion/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration_estimator.hpp"

namespace scree {
namespace {

using Values = CalibrationEstimator::Values;
constexpr std::size_t kParts = CalibrationEstimator::kParts;

int index_in(Calibrated which, Calibrated first) {
  return static_cast<int>(which) - static_cast<int>(first);
}

/// What is asked of one number.
struct Kind {
  Calibrated which;
  double most;        ///< a standard deviation above it shows nothing
  double systematic;  ///< that all parts of a drive have in common, a standard deviation
  bool is_angle;
  std::string_view why_not;
};

constexpr std::string_view kShort = "the ground bound the lidar for less than ten seconds";
constexpr std::string_view kNoWay = "too little was driven straight on ground that binds the lidar";
constexpr std::string_view kNoTurns = "too few turns: turn on the spot, to both sides";
constexpr std::string_view kNoImu =
    "the IMU said too little, or turned about one axis alone: drive over bumps";
constexpr std::string_view kNoWheel = "the encoder said too little, or hardly rolled";
constexpr std::string_view kNoJerks = "too even a drive: stop, start and turn sharply";

// By simulated drives of half a minute and more: wheels slip a little, and sink in.
constexpr std::array<Kind, kCalibrated> kKinds = {{
    {Calibrated::lidar_roll, 1, 0.1, true, kNoWay},
    {Calibrated::lidar_pitch, 1, 0.05, true, kNoWay},
    {Calibrated::lidar_yaw, 1, 0.05, true, kNoWay},
    {Calibrated::lidar_x, 0.05, 0.005, false, kNoTurns},
    {Calibrated::lidar_height, 0.05, 0.005, false, kNoWay},
    {Calibrated::imu_roll, 1.5, 0.1, true, kNoImu},
    {Calibrated::imu_pitch, 1.5, 0.1, true, kNoImu},
    {Calibrated::imu_yaw, 1.5, 0.1, true, kNoImu},
    {Calibrated::imu_delay, 0.02, 0.003, false, kNoJerks},
    {Calibrated::encoder_scale, 0.03, 0.007, false, kNoWheel},
    {Calibrated::encoder_y, 0.05, 0.01, false, kNoTurns},
    {Calibrated::encoder_delay, 0.02, 0.005, false, kNoJerks},
}};

double difference(const Kind& kind, double a, double b) {
  return kind.is_angle ? std::remainder(a - b, 360.0) : a - b;
}

/// Jackknife: the parts of a drive are far enough apart to be independent, unlike its sweeps.
double scatter(const Kind& kind, const std::array<Values, kParts>& without, double value) {
  double squares = 0;
  for (const Values& each : without) {
    const double off = difference(kind, each[static_cast<std::size_t>(kind.which)], value);
    squares += off * off;
  }
  return std::sqrt(squares * (kParts - 1) / kParts);
}

}  // namespace

Calibration calibrate(const DriveRecord& drive, const Settings& set) {
  const CalibrationEstimator estimator(drive, set);
  const bool is_long = estimator.windows() >= CalibrationEstimator::kLeastWindows;
  Values all;
  all.fill(std::numeric_limits<double>::quiet_NaN());
  std::array<Values, kParts> without;
  without.fill(all);
  if (is_long) {
    all = estimator.estimate(std::nullopt);
    for (std::size_t i = 0; i < kParts; ++i) without[i] = estimator.estimate(i);
  }
  Calibration found;
  for (const Kind& kind : kKinds) {
    const double value = all[static_cast<std::size_t>(kind.which)];
    // A scale is as good as its share of itself.
    const double unit = kind.which == Calibrated::encoder_scale ? std::abs(value) : 1;
    const double deviation = std::hypot(scatter(kind, without, value), kind.systematic * unit);
    CalibratedValue& result = found.values[static_cast<std::size_t>(kind.which)];
    result = {value, deviation, {}};
    if (deviation <= kind.most * unit) continue;  // not where there is no number
    const bool has_way = !std::isnan(all[static_cast<std::size_t>(Calibrated::lidar_roll)]);
    result.why_not = !is_long ? kShort : !has_way ? kNoWay : kind.why_not;
  }
  return found;
}

double set_value(const Settings& set, Calibrated which) {
  switch (which) {
    case Calibrated::lidar_roll:
    case Calibrated::lidar_pitch:
    case Calibrated::lidar_yaw:
      return set.lidar.rpy_deg(index_in(which, Calibrated::lidar_roll));
    case Calibrated::lidar_x:
      return set.lidar.translation.x();
    case Calibrated::lidar_height:
      return set.lidar.translation.z();
    case Calibrated::imu_roll:
    case Calibrated::imu_pitch:
    case Calibrated::imu_yaw:
      return set.imu.rpy_deg(index_in(which, Calibrated::imu_roll));
    case Calibrated::encoder_scale:
      return set.encoder.scale;
    case Calibrated::encoder_y:
      return set.encoder.translation.y();
    case Calibrated::imu_delay:
      return set.imu.delay;
    case Calibrated::encoder_delay:
      return set.encoder.delay;
  }
  return 0;
}

bool contradicts(const Calibration& found, const Settings& set, Calibrated which) {
  constexpr double kClear = 3;  // standard deviations
  const CalibratedValue& value = found[which];
  const Kind& kind = kKinds[static_cast<std::size_t>(which)];
  return value.why_not.empty() &&
         std::abs(difference(kind, value.value, set_value(set, which))) > kClear * value.deviation;
}

Settings with_calibration(Settings set, const Calibration& found) {
  const Settings before = set;
  const auto is_other = [&](Calibrated which) { return contradicts(found, before, which); };
  const auto take = [&](Calibrated which, double& value) {
    if (is_other(which)) value = found[which].value;
  };
  const auto take_delay = [&](Calibrated which, double& delay) {
    take(which, delay);
    delay = std::clamp(delay, -kMostDelay, kMostDelay);
  };
  // The angles of a rotation belong together.
  const auto take_rotation = [&](const std::array<Calibrated, 3>& angles, Eigen::Vector3d& rpy) {
    const bool is_shown =
        std::ranges::all_of(angles, [&](Calibrated which) { return found[which].why_not.empty(); });
    if (!is_shown || std::ranges::none_of(angles, is_other)) return;
    for (int i = 0; i < 3; ++i) rpy(i) = found[angles[static_cast<std::size_t>(i)]].value;
  };
  take_rotation({Calibrated::lidar_roll, Calibrated::lidar_pitch, Calibrated::lidar_yaw},
                set.lidar.rpy_deg);
  take_rotation({Calibrated::imu_roll, Calibrated::imu_pitch, Calibrated::imu_yaw},
                set.imu.rpy_deg);
  take(Calibrated::lidar_x, set.lidar.translation.x());
  take(Calibrated::lidar_height, set.lidar.translation.z());
  take_delay(Calibrated::imu_delay, set.imu.delay);
  take(Calibrated::encoder_scale, set.encoder.scale);
  take(Calibrated::encoder_y, set.encoder.translation.y());
  take_delay(Calibrated::encoder_delay, set.encoder.delay);
  return set;
}

}  // namespace scree
