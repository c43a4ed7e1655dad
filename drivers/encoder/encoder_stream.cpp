#include "scree/drivers/encoder/encoder_stream.hpp"

#include <numeric>
#include <utility>

#include "scree/drivers/encoder/signal.hpp"

namespace scree::encoder {

std::uint64_t EncoderCounters::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

EncoderStream::EncoderStream(const EncoderSettings& settings, OnSample on_sample,
                             OnReading on_reading)
    : settings_(settings),
      on_sample_(std::move(on_sample)),
      on_reading_(std::move(on_reading)),
      odometer_(settings) {}

/// Of several sources of one parameter group the first is taken: each counts by itself.
bool EncoderStream::is_mine(const CanFrame& frame) {
  const auto wanted = static_cast<std::uint32_t>(settings_.can_id);
  if (frame.is_extended != settings_.has_extended_id()) return false;
  if (((frame.id ^ wanted) & settings_.id_mask()) != 0) return false;
  if (settings_.any_source && !source_) source_ = frame.id;
  return !settings_.any_source || frame.id == *source_;
}

void EncoderStream::count_other(const CanFrame& frame) {
  constexpr std::uint32_t kGroup = 0x03FFFF00;  // SAE J1939-21: neither priority nor source
  ++counters_.other;
  const std::uint32_t differing = frame.id ^ static_cast<std::uint32_t>(settings_.can_id);
  if (frame.is_extended != settings_.has_extended_id()) {
    if (differing == 0) ++counters_.other_form;
  } else if (frame.is_extended && (differing & kGroup) == 0) {
    ++counters_.other_source;
    counters_.last_other_source = frame.id;
  }
}

void EncoderStream::take(const CanFrame& frame) {
  if (frame.is_error) return refuse(Refusal::error_frame);
  if (!is_mine(frame)) return count_other(frame);
  if (frame.is_remote) return refuse(Refusal::remote);
  const auto selected = is_selected(settings_, frame.payload());
  if (!selected) return refuse(Refusal::size);
  if (!*selected) {
    ++counters_.other;
    return;
  }
  const auto raw = read_signal(settings_, frame.payload());
  if (!raw) return refuse(Refusal::size);
  if (is_unavailable(settings_, *raw)) return refuse(Refusal::unavailable);

  const Reading reading{frame.t_ns, *raw, scaled(settings_, *raw)};
  if (on_reading_) on_reading_(reading);
  const Refusal refusal = odometer_.take(reading);
  counters_.rebased = odometer_.rebased();
  if (refusal != Refusal::none) return refuse(refusal);
  ++counters_.accepted;
  if (on_sample_) on_sample_({reading.t_ns, reading.raw, reading.value, odometer_.distance()});
}

}  // namespace scree::encoder
