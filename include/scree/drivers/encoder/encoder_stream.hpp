#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "scree/config/settings.hpp"
#include "scree/core/can_frame.hpp"
#include "scree/core/encoder_sample.hpp"
#include "scree/drivers/encoder/odometer.hpp"
#include "scree/drivers/encoder/refusal.hpp"

namespace scree::encoder {

struct EncoderCounters {
  std::uint64_t accepted = 0;                      ///< samples handed out
  std::array<std::uint64_t, kRefusals> refused{};  ///< by Refusal; [none] stays 0
  std::uint64_t other = 0;                         ///< frames that are not the encoder's
  std::uint64_t other_form = 0;                    ///< of these, its identifier in the other form
  std::uint64_t other_source = 0;                  ///< of these, its J1939 group from elsewhere
  std::uint32_t last_other_source = 0;             ///< identifier of the last one
  std::uint64_t rebased = 0;                       ///< see Odometer

  std::uint64_t all_refused() const;
};

/// All there is between the frames of the bus and samples; the daemon and the tools use it alike.
/// Allocates when it is made and never again. Deterministic.
class EncoderStream {
public:
  using OnSample = std::function<void(const EncoderSample&)>;
  using OnReading = std::function<void(const Reading&)>;

  /// `on_reading` is given every signal that could be read, plausible or not. Where the settings
  /// name a DBC file, with_dbc() must have filled them in.
  EncoderStream(const EncoderSettings& settings, OnSample on_sample, OnReading on_reading = {});

  /// Takes the next frame of the bus, of whatever identifier.
  void take(const CanFrame& frame);

  const EncoderCounters& counters() const { return counters_; }

private:
  bool is_mine(const CanFrame& frame);
  void count_other(const CanFrame& frame);
  void refuse(Refusal reason) { ++counters_.refused[static_cast<std::size_t>(reason)]; }

  EncoderSettings settings_;
  OnSample on_sample_;
  OnReading on_reading_;
  Odometer odometer_;
  std::optional<std::uint32_t> source_;  // where any may send: identifier of the first one
  EncoderCounters counters_;
};

}  // namespace scree::encoder
