#include "scree/clock/pps_edges.hpp"

#include <algorithm>
#include <cstdlib>

namespace scree {

bool PpsEdges::add(const ClockSample& edge, std::int64_t skew_ppb) {
  const bool agrees = !locked() || std::abs(edge.offset_ns -
                                            line(skew_ppb).offset_at(edge.device_ns)) <= kAgreement;
  if (!agrees && ++refused_in_row_ < 3) return false;
  if (!agrees) count_ = 0;
  refused_in_row_ = 0;
  if (count_ == kEdges) {
    std::copy(edges_.begin() + 1, edges_.end(), edges_.begin());
    --count_;
  }
  edges_[count_++] = edge;
  update_lock(skew_ppb);
  return agrees;
}

ClockLine PpsEdges::line(std::int64_t skew_ppb) const {
  const ClockSample& last = edges_[count_ - 1];
  std::array<std::int64_t, kEdges> offsets{};
  for (std::size_t i = 0; i < count_; ++i) {
    offsets[i] = edges_[i].offset_ns + gained_ns(last.device_ns - edges_[i].device_ns, skew_ppb);
  }
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(offsets.begin(), middle, offsets.begin() + static_cast<std::ptrdiff_t>(count_));
  return {last.device_ns, *middle, skew_ppb};
}

void PpsEdges::update_lock(std::int64_t skew_ppb) {
  const ClockLine median = line(skew_ppb);
  std::size_t agreeing = 0;
  jitter_ns_ = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const std::int64_t deviation =
        std::abs(edges_[i].offset_ns - median.offset_at(edges_[i].device_ns));
    if (deviation > kAgreement) continue;
    ++agreeing;
    jitter_ns_ = std::max(jitter_ns_, deviation);
  }
  locked_ = agreeing >= 3;
}

}  // namespace scree
