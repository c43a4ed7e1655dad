#pragma once

#include <cstdint>

namespace scree {

/// One plausible reading of the wheel encoder.
struct EncoderSample {
  std::int64_t t_ns = 0;  ///< host time of the frame
  std::int64_t raw = 0;   ///< the signal as sent; of an unsigned one of 64 bits the same bits
  double value = 0;       ///< raw as scaled: metres for a counter, m/s for a speed
  /// Metres that the wheel has rolled since the first reading, backwards below zero: a counter's
  /// without its wraps, a speed's sum over time.
  double distance = 0;
};

}  // namespace scree
