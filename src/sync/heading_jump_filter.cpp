#include "scree/sync/heading_jump_filter.hpp"

#include <cmath>

#include "scree/core/rotation.hpp"

namespace scree {

void HeadingJumpFilter::correct(ImuSample& sample) {
  constexpr double kLongest = 0.05;  // seconds between samples: beyond it two rates say too little
  constexpr double kFading = 1;      // seconds
  // More than the bias of a gyroscope of this class and the smoothing of its rate, rad ...
  constexpr double kMaxUnexplained = 0.026;
  constexpr double kScale = 0.02;  // ... more than an error of its scale, ...
  constexpr double kSigmas = 3;    // ... and than vibration between the samples.
  constexpr double kJerk = 5;      // rad/s from sample to sample: such a rate is garbled

  const ImuSample raw = sample;
  const double seconds = static_cast<double>(raw.t_ns - before_.t_ns) * 1e-9;
  if (has_before_ && seconds <= 0) return;
  if (has_before_ && seconds <= kLongest && raw.has_rate && before_.has_rate &&
      (raw.rate - before_.rate).norm() < kJerk) {
    const Eigen::Vector3d rate =
        (before_.orientation * before_.rate + raw.orientation * raw.rate) / 2;
    const double turn = logarithm(raw.orientation * before_.orientation.conjugate()).z();
    const double unexplained = turn - rate.z() * seconds;
    const double kept = std::exp(-seconds / kFading);
    unexplained_ = kept * unexplained_ + unexplained;
    turned_ = kept * turned_ + std::abs(turn);
    noise_ *= kept;
    if (std::abs(unexplained_) > kMaxUnexplained + kScale * turned_ + kSigmas * std::sqrt(noise_)) {
      correction_ -= unexplained_;
      unexplained_ = 0;
      ++corrections_;
    } else {
      // From sample to sample, for a turn that lasts is no noise.
      const double change = unexplained - last_unexplained_;
      noise_ += change * change / 2;
      last_unexplained_ = unexplained;
    }
  }
  before_ = raw;
  has_before_ = true;
  sample.orientation = exponential({0, 0, correction_}) * raw.orientation;
}

}  // namespace scree
