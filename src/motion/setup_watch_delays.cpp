#include <algorithm>
#include <array>
#include <cmath>

#include "scree/motion/setup_watch.hpp"

namespace scree {
namespace {

// What is sure of simulated right drives stays within 0.03 s.
constexpr double kLateDelay = 0.06, kRightDelay = 0.04;  // seconds
// Where the wheel has only sped up, or only slowed down, as much comes of a lidar that lost its
// way.
constexpr double kLateOneWay = 0.12, kLeastBalance = 0.1;  // seconds; share
constexpr double kClearDeviations = 4;                     // standard deviations ...
constexpr double kMostDeviation = 0.025;                   // ... of so many seconds
constexpr double kMostUnexplained = 0.5;
constexpr int kFewestWindows = 6;

}  // namespace

void SetupWatch::Lags::add(double behind, double gain) {
  behind_[count_] = behind;
  gain_[count_++] = gain;
}

SetupWatch::DelayFit SetupWatch::Lags::fit(double noise) const {
  constexpr int kRounds = 5;
  DelayFit fit;
  double scale = 0;
  for (int round = 0; round < kRounds; ++round) {
    double information = 0, ahead = 0, sum = 0, all = 0;
    std::array<double, kMost> errors{};
    for (std::size_t i = 0; i < count_; ++i) {
      const double error = behind_[i] - fit.delay * gain_[i];
      const double weight = round == 0 ? 1 : 1 / (1 + error * error / (scale * scale));
      information += weight * gain_[i] * gain_[i];
      if (gain_[i] > 0) ahead += weight * gain_[i] * gain_[i];
      sum += weight * gain_[i] * behind_[i];
      all += weight * behind_[i] * behind_[i];
    }
    if (information <= 0) return {};
    fit.balance = std::min(ahead, information - ahead) / information;
    fit.delay = sum / information;
    for (std::size_t i = 0; i < count_; ++i) {
      errors[i] = std::abs(behind_[i] - fit.delay * gain_[i]);
    }
    const auto middle = errors.begin() + count_ / 2;
    std::nth_element(errors.begin(), middle, errors.begin() + count_);
    scale = std::max(noise, 1.5 * *middle);
    fit.deviation = scale / std::sqrt(information);
    fit.unexplained = std::max(0.0, 1 - fit.delay * sum / std::max(all, 1e-12));
  }
  return fit;
}

SetupWatch::Verdict SetupWatch::judge_delay(const DelayFit& fit, SetupFault fault,
                                            double set) const {
  if (std::abs(fit.delay) < kLateDelay) {
    const bool is_sure = fit.deviation * kClearDeviations < kLateDelay;
    return {is_sure && std::abs(fit.delay) < kRightDelay ? Word::right : Word::unknown, {}};
  }
  const double deviation = std::min(kMostDeviation, std::abs(fit.delay) / kClearDeviations);
  if (fit.deviation > deviation || fit.unexplained > kMostUnexplained) return {};
  return {Word::wrong, {.fault = fault, .off = fit.delay, .set = {set + fit.delay, 0, 0}}};
}

/// A sensor that is late has yet to turn as it will turn in the time that it is late by.
SetupWatch::Verdict SetupWatch::judge_imu_delay() const {
  constexpr double kNoise = 0.004;  // rad
  Lags lags;
  int count = 0;
  for (const Seen& seen : windows()) {
    if (!seen.binds || !seen.has_imu) continue;
    ++count;
    for (int axis = 0; axis < 3; ++axis) {
      lags.add(seen.turn(axis) - seen.imu_turn(axis),
               seen.imu_turn_gain(axis) / SetupWindow::kBefore);
    }
  }
  if (count < kFewestWindows) return {};
  return judge_delay(lags.fit(kNoise), SetupFault::imu_delay, imu_delay_);
}

SetupWatch::Verdict SetupWatch::judge_encoder_delay(const WheelFit& wheel) const {
  constexpr double kNoise = 0.015;   // metres
  constexpr double kScaleOff = 0.2;  // the scale must be right first
  if (wheel.windows < kFewestWindows || std::abs(wheel.by_way - 1) > kScaleOff) return {};
  Lags lags;
  for (const Seen& seen : windows()) {
    if (!seen.binds || !seen.has_wheel || goes_aside(seen)) continue;
    const double way = std::copysign(seen.way.norm(), seen.way.x());
    lags.add(wheel.by_way * way + wheel.by_turn * seen.turn.z() - seen.wheel,
             seen.wheel_gain / SetupWindow::kBefore);
  }
  const DelayFit fit = lags.fit(kNoise);
  const bool is_one_way = fit.balance < kLeastBalance;
  if (is_one_way && std::abs(fit.delay) >= kLateDelay && std::abs(fit.delay) < kLateOneWay)
    return {};
  return judge_delay(fit, SetupFault::encoder_delay, encoder_delay_);
}

}  // namespace scree
