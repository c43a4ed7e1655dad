#include "scree/clock/device_clock.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

/// How far the clocks may run apart in a time: 200 ppm, four times what crystals are good for.
constexpr std::int64_t drift(std::int64_t elapsed_ns) {
  return std::max<std::int64_t>(elapsed_ns, 0) / 5000;
}

/// A packet this much before its time has been stamped by another clock than those before it ...
constexpr std::int64_t kTooEarly = 50 * kMillisecond;
/// ... and so has one this much after it, whatever delays a busy host may have.
constexpr std::int64_t kTooLate = kSecond;
/// Nothing waits in a buffer for as long.
constexpr std::int64_t kLongestWait = 600 * kSecond;
/// A device whose clock went back by more than packets overtake each other has started over.
constexpr std::int64_t kBackwards = 50 * kMillisecond;
/// Packets that tell of another clock must agree within this ...
constexpr std::int64_t kAgreement = 50 * kMillisecond;
/// ... for this long: longer than what waited in a buffer takes to come in.
constexpr std::int64_t kCertainAfter = 100 * kMillisecond;

/// Smaller steps of the host's clock: every packet is late by this much, and by eight times the
/// usual ...
constexpr std::int64_t kLate = 5 * kMillisecond;
/// ... for this long.
constexpr std::int64_t kLateFor = kSecond;
/// Or every packet is early: two by this much ...
constexpr std::int64_t kEarly = kMillisecond;
/// ... within this time.
constexpr std::int64_t kEarlyWithin = 10 * kSecond;

/// One at least of so many packets over so long had next to no delay.
constexpr std::int64_t kEnoughPackets = 20, kLongEnough = kSecond;

/// Host times given out are brought to the best known by one part of this of the time that goes by.
constexpr std::int64_t kSlewAtFirst = 2, kSlew = 4;

/// The packets' least delay is below this, and none comes before it was sent; an edge that says
/// otherwise is not of the device's clock.
constexpr std::int64_t kLongestDelay = 20 * kMillisecond, kEdgeLate = 2 * kMillisecond;
constexpr std::int64_t kEdgeHolds = 5 * kSecond;

}  // namespace

const char* name_of(ClockState state) {
  constexpr std::array kNames = {"unsynchronised", "estimated", "pps_locked"};
  return kNames[static_cast<std::size_t>(state)];
}

std::int64_t DeviceClock::wrapped(std::int64_t difference_ns) const {
  const std::int64_t rest = difference_ns % period_ns_;
  if (rest >= (period_ns_ + 1) / 2) return rest - period_ns_;
  if (rest < -period_ns_ / 2) return rest + period_ns_;
  return rest;
}

bool DeviceClock::update(std::int64_t device_ns, std::int64_t arrival_ns) {
  if (!started_) {
    const ClockSample first{device_ns, arrival_ns - device_ns};
    restart(first, first);
    return true;
  }
  const std::int64_t host_elapsed = arrival_ns - last_.host_ns();
  // The device's clock tells how much time went by, but not how many of its periods; the host's
  // knows well enough.
  const std::int64_t device_elapsed =
      host_elapsed + wrapped(device_ns - last_.device_ns - host_elapsed);
  const std::int64_t now_ns = last_.device_ns + device_elapsed;
  const ClockSample sample{now_ns, arrival_ns - now_ns};
  const std::int64_t excess = envelope_.excess_ns(sample), leak = drift(host_elapsed);

  const bool is_late = excess > kTooLate + leak, is_backwards = device_elapsed < -kBackwards;
  if (is_backwards || is_late || excess < -kTooEarly - leak) {
    const bool has_waited = is_late && !is_backwards && excess < kLongestWait;
    return handle_outlier(device_ns, arrival_ns, has_waited);
  }
  outliers_.reset();
  if (is_late_for_long(sample)) {
    ++host_steps_;
    restart(sample, late_run_->least);
    return true;
  }
  if (late_run_) {
    // They tell nothing of the envelope, but would make delays of this size look usual.
  } else if (excess >= -kEarly - leak) {
    envelope_.add(sample);
  } else if (early_ && sample.device_ns - early_->device_ns < kEarlyWithin) {
    envelope_.reset(*early_);
    envelope_.add(sample);
    early_.reset();
  } else {
    early_ = sample;
  }
  accept(sample);
  return false;
}

void DeviceClock::accept(const ClockSample& sample) {
  ++packets_;
  if (sample.device_ns > last_.device_ns) {
    last_ = sample;
    state_ = next_state();
    slew_to(sample.device_ns);
  }
  anchor_device_ns_ = last_.device_ns;
  anchor_host_ns_ = last_.device_ns + slewed_.offset_ns;
}

bool DeviceClock::is_late_for_long(const ClockSample& sample) {
  const std::int64_t excess = envelope_.excess_ns(sample);
  if (excess <= kLate + 8 * envelope_.usual_excess_ns()) {
    late_run_.reset();
    return false;
  }
  if (!late_run_) late_run_ = {sample.host_ns(), sample};
  if (excess < envelope_.excess_ns(late_run_->least)) late_run_->least = sample;
  return sample.host_ns() - late_run_->since_ns > kLateFor;
}

bool DeviceClock::handle_outlier(std::int64_t device_ns, std::int64_t arrival_ns, bool has_waited) {
  ++implausible_;
  const auto begin = [&] {
    outliers_ = {device_ns, arrival_ns, {device_ns, arrival_ns - device_ns}};
  };
  if (!outliers_) begin();
  const std::int64_t elapsed = wrapped(device_ns - outliers_->first_device_ns);
  const std::int64_t host_elapsed = arrival_ns - outliers_->first_arrival_ns;
  if (std::abs(elapsed - host_elapsed) > kAgreement + drift(host_elapsed)) begin();

  const std::int64_t now_ns = outliers_->first_device_ns + elapsed;
  const ClockSample sample{now_ns, arrival_ns - now_ns};
  if (sample.offset_ns < outliers_->least.offset_ns) outliers_->least = sample;
  if (arrival_ns - outliers_->first_arrival_ns >= kCertainAfter) {
    const std::int64_t step = wrapped(outliers_->first_device_ns - last_.device_ns);
    const bool device_is_steady = step > 0 && step < kSecond;
    ++(device_is_steady ? host_steps_ : device_restarts_);
    restart(sample, outliers_->least);
    return true;
  }
  // What waited in a buffer is late, and its stamps are right all the same.
  if (!has_waited) {
    anchor_device_ns_ = device_ns;
    anchor_host_ns_ = arrival_ns;
  }
  return false;
}

void DeviceClock::restart(const ClockSample& newest, const ClockSample& least) {
  started_ = true;
  state_ = ClockState::unsynchronised;
  last_ = newest;
  begin_device_ns_ = newest.device_ns;
  packets_ = 1;
  envelope_.reset(least);
  envelope_.add(newest);
  edges_.clear();
  outliers_.reset();
  late_run_.reset();
  early_.reset();
  const ClockLine& line = envelope_.line();
  slewed_ = {newest.device_ns, line.offset_at(newest.device_ns), line.skew_ppb};
  anchor_device_ns_ = newest.device_ns;
  anchor_host_ns_ = newest.device_ns + slewed_.offset_ns;
}

void DeviceClock::slew_to(std::int64_t device_ns) {
  const ClockLine line = best_line();
  const std::int64_t slew = state_ == ClockState::unsynchronised ? kSlewAtFirst : kSlew;
  const std::int64_t most = (device_ns - slewed_.device_ns) / slew;
  const std::int64_t expected = slewed_.offset_at(device_ns);
  const std::int64_t change = std::clamp(line.offset_at(device_ns) - expected, -most, most);
  slewed_ = {device_ns, expected + change, line.skew_ppb};
}

ClockState DeviceClock::next_state() const {
  if (state_ == ClockState::unsynchronised) {
    const bool enough =
        packets_ >= kEnoughPackets && last_.device_ns - begin_device_ns_ >= kLongEnough;
    return enough ? ClockState::estimated : ClockState::unsynchronised;
  }
  const bool locked = edges_.locked() && last_.host_ns() - last_edge_ns_ < kEdgeHolds;
  return locked ? ClockState::pps_locked : ClockState::estimated;
}

ClockLine DeviceClock::best_line() const {
  const ClockLine& line = envelope_.line();
  return state_ == ClockState::pps_locked ? edges_.line(line.skew_ppb) : line;
}

void DeviceClock::pps(std::int64_t host_edge_ns) {
  if (state_ == ClockState::unsynchronised || period_ns_ % kSecond != 0) return;
  const ClockLine& line = envelope_.line();
  const std::int64_t about_ns = host_edge_ns - line.offset_at(last_.device_ns);
  const std::int64_t second_ns = (about_ns + kSecond / 2) / kSecond * kSecond;
  const ClockSample edge{second_ns, host_edge_ns - second_ns};
  const std::int64_t excess = envelope_.excess_ns(edge);
  if (excess < -kLongestDelay || excess > kEdgeLate || !edges_.add(edge, line.skew_ppb)) {
    ++edges_refused_;
    return;
  }
  last_edge_ns_ = host_edge_ns;
}

std::int64_t DeviceClock::to_host(std::int64_t device_ns) const {
  const std::int64_t elapsed = wrapped(device_ns - anchor_device_ns_);
  return anchor_host_ns_ + elapsed + gained_ns(elapsed, slewed_.skew_ppb);
}

std::int64_t DeviceClock::accuracy_ns() const {
  const std::int64_t behind =
      std::abs(best_line().offset_at(slewed_.device_ns) - slewed_.offset_ns);
  if (state_ == ClockState::pps_locked) return behind + edges_.jitter_ns();
  const bool is_new = state_ == ClockState::unsynchronised;
  return behind + std::max(envelope_.accuracy_ns(), is_new ? kLate : 0);
}

ClockStatus DeviceClock::status(std::int64_t ahead_ns) const {
  if (!started_) return {};
  return {state_, wrapped(anchor_host_ns_ + ahead_ns - anchor_device_ns_), accuracy_ns()};
}

}  // namespace scree
