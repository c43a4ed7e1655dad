#include "scree/drivers/encoder/odometer.hpp"

#include <algorithm>
#include <cmath>

#include "scree/drivers/encoder/signal.hpp"

namespace scree::encoder {
namespace {

// The rules that these numbers belong to stand at the class.
constexpr double kJitter = 0.03;      // s, of a time stamp: USB adapters hand frames on in bursts
constexpr double kChangeOver = 0.1;   // s, a speed's change is judged over at least this
constexpr double kLeastTrend = 0.05;  // s, a shorter past has no trend
constexpr double kLeastToFreeze = 0.15;  // s, a shorter past does not tell the frames' interval
constexpr double kRoomToBrake = 1.5;     // the interval is known to a fifth or so
constexpr std::int64_t kPastNs = 250'000'000;
constexpr std::size_t kLeastPast = 8;              // readings kept however old they are
constexpr std::size_t kSteps = 4;                  // that a reading must break off to be frozen
constexpr std::int64_t kGapNs = 350'000'000;       // more than three frames of the slowest encoder
constexpr std::int64_t kFrozenNs = 1'000'000'000;  // a wheel that stands longer is blocked
constexpr int kSuspects = 4;                       // refused readings that agree are right ...
constexpr std::int64_t kSuspectsNs = 50'000'000;   // ... when they last this long

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

/// The difference of two counts within the counter's length: the one nearest to zero.
double counts(std::int64_t from, std::int64_t to, int length) {
  const auto unused = static_cast<unsigned>(64 - length);
  const std::uint64_t difference =
      static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from);
  return static_cast<double>(static_cast<std::int64_t>(difference << unused) >> unused);
}

}  // namespace

Odometer::Odometer(const EncoderSettings& settings)
    : settings_(settings), quantum_(quantum(settings)) {}

Refusal Odometer::take(const Reading& reading) {
  const bool is_counter = settings_.kind == EncoderKind::counter;
  const bool is_after_gap = has_frame_ && reading.t_ns - last_frame_ns_ >= kGapNs;
  has_frame_ = true;
  last_frame_ns_ = reading.t_ns;
  if (!has_last_) {
    const bool is_too_fast = !is_counter && !agree(reading, reading);
    return is_too_fast ? suspect(Refusal::implausible, reading) : accept(reading, 0);
  }
  if (reading.t_ns <= last_.t_ns) return suspect(Refusal::time, reading);
  const bool is_long_ago = reading.t_ns - last_.t_ns >= kGapNs;
  const double speed_before = trend() ? trend()->speed : 0;
  if (is_long_ago) past_size_ = 0;
  if (is_counter && stands_frozen(reading)) return Refusal::frozen;
  if (!agree(last_, reading) || !fits_trend(reading)) return suspect(Refusal::implausible, reading);
  if (is_long_ago && (!is_counter || may_have_wrapped(reading))) return rebase(reading, 0);
  if (is_counter && is_after_gap && has_restarted(reading, speed_before)) {
    return rebase(reading, 0);
  }
  return accept(reading, moved(last_, reading));
}

double Odometer::moved(const Reading& from, const Reading& to) const {
  if (settings_.kind == EncoderKind::speed) {
    return (from.value + to.value) / 2 * seconds(from.t_ns, to.t_ns);
  }
  return counts(from.raw, to.raw, settings_.length) * settings_.factor * settings_.scale;
}

bool Odometer::agree(const Reading& from, const Reading& to) const {
  const double time = seconds(from.t_ns, to.t_ns);
  if (settings_.kind == EncoderKind::speed) {
    const double change = settings_.max_acceleration * (time + kChangeOver) + 2 * quantum_;
    return std::abs(to.value) <= settings_.max_speed + quantum_ &&
           std::abs(to.value - from.value) <= change;
  }
  return std::abs(moved(from, to)) <= settings_.max_speed * (time + kJitter) + 2 * quantum_;
}

std::optional<Odometer::Trend> Odometer::trend() const {
  if (past_size_ == 0) return std::nullopt;
  const Past &first = past_.front(), &last = past_[past_size_ - 1];
  const double window = seconds(first.t_ns, last.t_ns);
  if (window < kLeastTrend) return std::nullopt;
  return Trend{window, (last.distance - first.distance) / window};
}

bool Odometer::fits_trend(const Reading& reading) const {
  const auto past = trend();
  if (settings_.kind == EncoderKind::speed || !past) return true;
  const auto [window, speed] = *past;
  const double time = seconds(last_.t_ns, reading.t_ns);
  const double acceleration = settings_.max_acceleration;
  // How far the speed at the end of the past may be from its mean, and the mean from the truth.
  const double error =
      acceleration * window / 2 + (2 * quantum_ + std::abs(speed) * kJitter) / window;
  const double jitter = (std::abs(speed) + acceleration * (window + time)) * kJitter;
  const double off = std::abs(moved(last_, reading) - speed * time);
  return off <= 2 * quantum_ + jitter + (error + acceleration * time / 2) * time;
}

bool Odometer::may_have_wrapped(const Reading& reading) const {
  const double half = std::ldexp(quantum_, settings_.length - 1);
  return settings_.max_speed * (seconds(last_.t_ns, reading.t_ns) + kJitter) >= half;
}

bool Odometer::has_restarted(const Reading& reading, double speed_before) const {
  const Reading zero{last_.t_ns, 0, 0};
  const double way = moved(last_, reading), from_zero = moved(zero, reading);
  // A device that is back after a while has counted a part of what was rolled meanwhile.
  const double expected = speed_before * seconds(last_.t_ns, reading.t_ns);
  const double counted = std::clamp(from_zero, std::min(expected, 0.0), std::max(expected, 0.0));
  return std::abs(from_zero) < std::abs(way) &&
         std::abs(from_zero - counted) < std::abs(way - expected);
}

bool Odometer::stands_frozen(const Reading& reading) {
  if (reading.raw != last_.raw) {
    is_frozen_ = false;
    return false;
  }
  if (!is_frozen_) {
    if (!stopped_too_fast()) return false;
    frozen_since_ns_ = reading.t_ns;
    is_frozen_ = true;
  }
  if (reading.t_ns - frozen_since_ns_ < kFrozenNs) return true;
  is_frozen_ = false;
  past_size_ = 0;
  return false;
}

bool Odometer::stopped_too_fast() const {
  if (past_size_ <= kSteps) return false;
  const double window = seconds(past_.front().t_ns, past_[past_size_ - 1].t_ns);
  if (window < kLeastToFreeze) return false;
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = past_size_ - kSteps; i < past_size_; ++i) {
    const double step = past_[i].distance - past_[i - 1].distance;
    least = std::min(least, step);
    most = std::max(most, step);
  }
  const double interval = window / static_cast<double>(past_size_ - 1);
  const double change = kRoomToBrake * settings_.max_acceleration * interval * interval;
  return std::max(least, -most) > change + 2 * quantum_;
}

Refusal Odometer::suspect(Refusal reason, const Reading& reading) {
  const bool goes_on = suspects_ > 0 && reading.t_ns > last_suspect_.t_ns &&
                       reading.t_ns - last_suspect_.t_ns < kGapNs && agree(last_suspect_, reading);
  suspects_moved_ = goes_on ? suspects_moved_ + moved(last_suspect_, reading) : 0;
  suspects_ = goes_on ? suspects_ + 1 : 1;
  if (!goes_on) first_suspect_ = reading;
  last_suspect_ = reading;
  if (suspects_ < kSuspects || reading.t_ns - first_suspect_.t_ns < kSuspectsNs) return reason;
  return rebase(reading, suspects_moved_);
}

Refusal Odometer::rebase(const Reading& reading, double moved) {
  ++rebased_;
  past_size_ = 0;
  return accept(reading, moved);
}

Refusal Odometer::accept(const Reading& reading, double moved) {
  distance_ += moved;
  last_ = reading;
  has_last_ = true;
  suspects_ = 0;
  is_frozen_ = false;

  std::size_t old = 0;
  while (past_size_ - old >= kLeastPast && reading.t_ns - past_[old].t_ns > kPastNs) ++old;
  if (past_size_ - old == past_.size()) ++old;
  std::copy(past_.data() + old, past_.data() + past_size_, past_.data());
  past_size_ -= old;
  past_[past_size_++] = {reading.t_ns, distance_};
  return Refusal::none;
}

}  // namespace scree::encoder
