#include "scree/drivers/velodyne/lidar_stream.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree::velodyne {
namespace {

/// Packets this much older than the one before them were overtaken on the way; older ones come from
/// a sensor that started over (or a capture that is played again).
constexpr std::int64_t kMostLateNs = 50'000'000;

/// After this the loss is not estimated: the sensor was off, or its clock has jumped.
constexpr std::int64_t kLongestGapNs = 60'000'000'000;

std::size_t mode_index(ReturnMode mode) {
  return static_cast<std::size_t>(mode) - static_cast<std::size_t>(ReturnMode::strongest);
}

}  // namespace

std::uint64_t LidarCounters::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

LidarStream::LidarStream(const LidarSettings& settings, OnSweep on_sweep, OnPacket on_packet,
                         int parts)
    : decoder_(settings.model),
      model_(settings.model),
      on_sweep_(std::move(on_sweep)),
      on_packet_(std::move(on_packet)),
      builder_(settings.cut_azimuth_deg, parts, [this](Sweep& sweep) { hand_out(sweep); }) {}

void LidarStream::hand_out(Sweep& sweep) {
  if (sweep.ends_turn) {
    ++counters_.sweeps;
    if (sweep.is_standing) ++counters_.standing;
    counters_.dropped += sweep.dropped;
  } else {
    ++counters_.parts;
  }
  if (on_sweep_) on_sweep_(sweep);
}

void LidarStream::take(Bytes datagram, std::int64_t arrival_ns) {
  const Refusal refusal = check_data_packet(datagram, model_);
  if (refusal != Refusal::none) return refuse(refusal);
  if (product(datagram) != Product::hdl32e) return put_in_order(datagram, arrival_ns);

  const Firmware firmware = firmware_detector_.update(timestamp_us(datagram));
  if (firmware == Firmware::undecided) return hold(datagram, arrival_ns);
  release(firmware == Firmware::early_vlp16);
  if (firmware == Firmware::hdl32e) return refuse(Refusal::timing);
  put_in_order(datagram, arrival_ns);
}

void LidarStream::hold(Bytes packet, std::int64_t arrival_ns) {
  if (held_count_ == held_.size()) {
    std::move(held_.begin() + 1, held_.end(), held_.begin());
    --held_count_;
    refuse(Refusal::timing);
  }
  std::copy(packet.begin(), packet.end(), held_[held_count_].bytes.begin());
  held_[held_count_].arrival_ns = arrival_ns;
  ++held_count_;
}

void LidarStream::release(bool accept_them) {
  for (std::size_t i = 0; i < held_count_; ++i) {
    if (accept_them) {
      put_in_order(held_[i].bytes, held_[i].arrival_ns);
    } else {
      refuse(Refusal::timing);
    }
  }
  held_count_ = 0;
}

void LidarStream::flush() {
  release(false);
  while (early_count_ > 0) accept_first_early();
  builder_.finish();
}

/// Time stamp since that of the packet before. @pre previous_
std::int64_t LidarStream::elapsed_ns(Bytes packet) const {
  // Within half an hour around zero; how many hours went by is the clock's business.
  const std::int64_t stamp_ns = std::int64_t{timestamp_us(packet)} * 1000;
  const std::int64_t elapsed = (stamp_ns - previous_->device_ns % kHourNs + kHourNs) % kHourNs;
  return elapsed >= kHourNs / 2 ? elapsed - kHourNs : elapsed;
}

/// How long the sensor must have sent something else between the packet before and this one.
std::int64_t LidarStream::gap_ns(Bytes packet) const {
  return previous_ ? elapsed_ns(packet) - previous_->duration_ns : 0;
}

/// Datagrams overtake each other on their way. One that leaves a gap of a few packets waits until
/// the gap is filled or as many others wait; without disorder and loss nothing waits.
void LidarStream::put_in_order(Bytes packet, std::int64_t arrival_ns) {
  if (!one_clock_.takes(std::int64_t{timestamp_us(packet)} * 1000, arrival_ns)) {
    return refuse(Refusal::second_sensor);
  }
  const std::int64_t packet_ns = packet_duration_ns(return_mode(packet)), half = packet_ns / 2;
  const std::int64_t most = static_cast<std::int64_t>(early_.size()) * packet_ns + half;
  const auto is_early = [&] { return gap_ns(packet) > half && gap_ns(packet) <= most; };
  const auto is_next_or_late = [&] {
    return gap_ns(packet) <= half && gap_ns(packet) > -kMostLateNs;
  };
  while (early_count_ > 0 && !is_next_or_late() && !(is_early() && early_count_ < early_.size())) {
    accept_first_early();
  }
  if (is_early()) {
    keep_early(packet, arrival_ns);
  } else {
    accept(packet, arrival_ns);
  }
  while (early_count_ > 0 && gap_ns(early_[0].bytes) <= half) accept_first_early();
}

/// Oldest first. @pre there is room
void LidarStream::keep_early(Bytes packet, std::int64_t arrival_ns) {
  std::size_t at = early_count_;
  while (at > 0 && elapsed_ns(early_[at - 1].bytes) >= elapsed_ns(packet)) --at;
  if (at < early_count_ && timestamp_us(early_[at].bytes) == timestamp_us(packet)) {
    return refuse(Refusal::duplicate);
  }
  const auto begin = early_.begin() + static_cast<std::ptrdiff_t>(at);
  const auto end = early_.begin() + static_cast<std::ptrdiff_t>(early_count_);
  std::move_backward(begin, end, end + 1);
  std::copy(packet.begin(), packet.end(), begin->bytes.begin());
  begin->arrival_ns = arrival_ns;
  ++early_count_;
}

void LidarStream::accept_first_early() {
  const Held first = early_[0];
  std::move(early_.begin() + 1, early_.begin() + static_cast<std::ptrdiff_t>(early_count_),
            early_.begin());
  --early_count_;
  accept(first.bytes, first.arrival_ns);
}

void LidarStream::accept(Bytes packet, std::int64_t arrival_ns) {
  const std::int64_t stamp_ns = std::int64_t{timestamp_us(packet)} * 1000;
  const std::int64_t sent_ns = stamp_ns + packet_duration_ns(return_mode(packet));

  const std::int64_t since_ns = previous_ ? elapsed_ns(packet) : 0;
  if (previous_ && since_ns == 0) return refuse(Refusal::duplicate);
  if (since_ns < 0 && since_ns > -kMostLateNs) return refuse(Refusal::late);
  // Two sensors whose clocks are set by the same GPS send between each other's packets.
  const std::int64_t packet_ns = packet_duration_ns(return_mode(packet));
  const std::int64_t soonest = previous_ ? std::min(packet_ns, previous_->duration_ns) * 4 / 5 : 0;
  if (since_ns > 0 && since_ns < soonest) return refuse(Refusal::second_sensor);

  const bool started_over = clock_.update(sent_ns % kHourNs, arrival_ns);
  counters_.device_restarts = clock_.device_restarts();
  counters_.host_steps = clock_.host_steps();
  if (counters_.accepted > 0 && (started_over || since_ns < 0)) {
    builder_.start_over();
    previous_.reset();
  }

  decoder_.decode(packet, shots_);
  if (previous_) count_lost(since_ns);
  const std::int64_t device_ns = previous_ ? previous_->device_ns + since_ns : stamp_ns;
  const std::int64_t host_ns = clock_.to_host(stamp_ns);

  std::int64_t duration_ns = packet_duration_ns(shots_.mode);
  if (shots_.skipped_deg > 0 && shots_.degrees_per_block > 0) {
    const float blocks_skipped = shots_.skipped_deg / shots_.degrees_per_block;
    field_of_view_begin_ = shots_.resumed_at;
    duration_ns += static_cast<std::int64_t>(blocks_skipped * static_cast<float>(kBlockNs));
  }
  previous_ = Previous{device_ns, duration_ns};

  ++counters_.by_mode[mode_index(shots_.mode)];
  if (on_packet_) on_packet_({counters_.accepted, host_ns, shots_});
  ++counters_.accepted;
  builder_.add(shots_, device_ns, host_ns - device_ns);
}

void LidarStream::count_lost(std::int64_t elapsed_ns) {
  if (elapsed_ns > kLongestGapNs) return;
  const std::int64_t beyond_ns = elapsed_ns - previous_->duration_ns;
  const std::int64_t packet_ns = packet_duration_ns(shots_.mode);
  if (beyond_ns <= packet_ns / 2) return;
  // The sensor was silent outside its field of view, and this packet is the first inside.
  constexpr float kNear = 200;
  if (field_of_view_begin_ >= 0 && std::abs(shots_.azimuth[0] - field_of_view_begin_) < kNear)
    return;
  counters_.lost += static_cast<std::uint64_t>((beyond_ns + packet_ns / 2) / packet_ns);
}

}  // namespace scree::velodyne
