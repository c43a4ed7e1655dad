#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scree/clock/clock_line.hpp"

namespace scree {

/// The edges of a pulse per second at which a device's clock stood at a whole second: what offset
/// they say the host's clock has from the device's. The median of the last kEdges, so that an edge
/// that was stamped late counts for nothing.
class PpsEdges {
public:
  static constexpr std::size_t kEdges = 9;
  /// Edges of one clock agree within this; a busy processor stamps most within 10 us.
  static constexpr std::int64_t kAgreement = 100'000;

  void clear() { count_ = refused_in_row_ = 0; }
  /// Takes an edge; false when it does not agree with the ones before. After three such in a row
  /// those before are forgotten.
  bool add(const ClockSample& edge, std::int64_t skew_ppb);
  /// Whether three edges agree.
  bool locked() const { return locked_ && count_ > 0; }
  /// The offset at the last edge, as a line. @pre locked()
  ClockLine line(std::int64_t skew_ppb) const;
  /// The largest deviation of those that agree. @pre locked()
  std::int64_t jitter_ns() const { return jitter_ns_; }

private:
  void update_lock(std::int64_t skew_ppb);

  std::array<ClockSample, kEdges> edges_{};  ///< oldest first
  std::size_t count_ = 0, refused_in_row_ = 0;
  bool locked_ = false;
  std::int64_t jitter_ns_ = 0;
};

}  // namespace scree
