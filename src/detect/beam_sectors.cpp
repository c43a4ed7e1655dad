#include "scree/detect/beam_sectors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

std::size_t BeamSectors::sector_of(float x, float y) const {
  constexpr float kPi = std::numbers::pi_v<float>;
  const float share = (std::atan2(y - origin_.y(), x - origin_.x()) + kPi) / (2 * kPi);
  return std::min(static_cast<std::size_t>(share * kSectors), kSectors - 1);
}

void BeamSectors::build(PointView points, const Eigen::Vector3f& origin) {
  origin_ = origin;
  begin_.fill(0);
  for (std::size_t i = 0; i < points.size(); ++i) ++begin_[sector_of(points.x[i], points.y[i])];
  std::uint32_t end = 0;
  for (std::uint32_t& begin : begin_) end = begin += end;
  sorted_.resize(points.size());
  for (std::size_t i = points.size(); i-- > 0;) {
    const float range = std::hypot(points.x[i] - origin.x(), points.y[i] - origin.y());
    sorted_[--begin_[sector_of(points.x[i], points.y[i])]] = {range, points.z[i]};
  }
}

Evidence BeamSectors::of(std::span<const std::uint32_t> members, const PointCloud& points,
                         float ground) const {
  constexpr float kBelow = 0.05F;  // metres
  constexpr std::size_t kFewest = 3;
  std::size_t below = 0, into = 0;
  for (const std::uint32_t i : members) {
    if (points.z[i] > ground - kBelow) continue;
    ++below;
    if (goes_into(points.x[i], points.y[i], points.z[i], ground)) ++into;
  }
  return into >= kFewest && 5 * into > 2 * below ? Evidence::inside : Evidence::none;
}

/// Whether the beam that ended in a point passed the level of the ground between ground that was
/// seen and the point, and nothing was seen there.
bool BeamSectors::goes_into(float x, float y, float z, float ground) const {
  constexpr float kLevel = 0.1F, kSlope = 0.15F;  // of the ground before it: metres, metres a metre
  constexpr float kGap = 1, kGapShare = 0.35F;    // between rings: metres, share of the range
  constexpr float kClear = 0.1F;                  // of rounded rims, metres
  if (ground >= origin_.z()) return false;
  const float range = std::hypot(x - origin_.x(), y - origin_.y());
  const float crossing = range * (origin_.z() - ground) / (origin_.z() - z);
  const float nearest = crossing - std::max(kGap, kGapShare * crossing);
  const std::size_t sector = sector_of(x, y);
  bool has_ground = false;
  for (std::uint32_t i = begin_[sector]; i < begin_[sector + 1]; ++i) {
    const Entry& seen = sorted_[i];
    const float off = kLevel + kSlope * std::abs(crossing - seen.range);
    const bool is_level = std::abs(seen.z - ground) < off;
    if (is_level && seen.range > nearest && seen.range < crossing + kClear) has_ground = true;
    const bool is_between = seen.range > crossing + kClear && seen.range < range - kClear;
    if (is_between && seen.z > ground - kClear / 2) return false;
  }
  return has_ground;
}

}  // namespace scree
