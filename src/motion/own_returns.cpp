#include "scree/motion/own_returns.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr float kReach = 2.5F;         // metres from the lidar: what lies farther is not the robot
constexpr float kBorder = 2.35F;       // what comes this near to it goes on beyond
constexpr float kLowest = 0.15F;       // metres above the origin of base
constexpr float kFarTolerance = 0.1F;  // metres
constexpr double kRoom = 0.08F;        // around what was found: noise, and what lies between beams
constexpr float kLeastWay = 2.5F;      // metres: rough ground may keep its distance for 1.5 m

// Directions: 2 degrees apart in height, as the lidar's lasers, and 1.8 aside.
constexpr std::size_t kRows = 16, kColumns = 200, kBins = kRows * kColumns;
constexpr float kLowestRow = -15, kRowHeight = 2;  // degrees

std::size_t bin_of(const Eigen::Vector3f& point, float range) {
  constexpr auto kPi = static_cast<float>(M_PI);
  const float elevation = std::asin(point.z() / range) * 180 / kPi;
  const float row =
      std::clamp(std::round((elevation - kLowestRow) / kRowHeight), 0.0F, kRows - 1.0F);
  const float turn = std::atan2(point.y(), point.x()) / (2 * kPi) + 0.5F;
  const std::size_t column = static_cast<std::size_t>(turn * kColumns) % kColumns;
  return static_cast<std::size_t>(row) * kColumns + column;
}

/// The bins beside one, around the circle.
template <class Visit>
void for_each_beside(std::size_t bin, Visit&& visit) {
  const std::size_t row = bin / kColumns, column = bin % kColumns;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(row + 1, kRows - 1); ++r) {
    for (const std::size_t aside : {kColumns - 1, std::size_t{0}, std::size_t{1}}) {
      visit(r * kColumns + (column + aside) % kColumns);
    }
  }
}

}  // namespace

OwnReturns::OwnReturns(std::span<const BodyBox> body, const Pose& mount)
    : to_base_(Eigen::Translation3f(mount.translation.cast<float>()) *
               mount.rotation.cast<float>()),
      body_(body.size()),
      found_(kMostFound),
      bins_(kBins),
      visited_(kBins),
      members_(kBins) {
  for (const BodyBox& box : body) body_.push_back(box);
  bins_.assign(kBins, Bin());
}

bool OwnReturns::covers(const Eigen::Vector3f& in_base) const {
  const auto contains = [place = in_base.cast<double>().eval()](const BodyBox& box) {
    return box.contains(place);
  };
  return std::ranges::any_of(body_, contains) || std::ranges::any_of(found_, contains);
}

bool OwnReturns::take(const Eigen::Vector3f& point) {
  constexpr std::uint8_t kFewSweeps = 5;
  constexpr float kTolerance = 0.08F;
  is_suspect_ = false;
  if (covers(to_base_ * point)) {
    ++returns_;
    return true;
  }
  const float range = point.norm();
  if (!(range > 0 && std::isfinite(range))) return false;
  Bin& bin = bins_[bin_of(point, range)];
  if (bin.range == 0 || range < bin.range) {
    bin.range = range;
    bin.nearest = point;
  }
  is_suspect_ =
      range < kReach && bin.sweeps >= kFewSweeps && std::abs(range - bin.kept) < kTolerance;
  return false;
}

bool OwnReturns::end_sweep(float way) {
  constexpr float kTolerance = 0.04F;  // metres: some deviations of the lidar's noise
  constexpr float kNewest = 0.2F;      // share of the newest range in the one that is kept
  for (Bin& bin : bins_) {
    const bool is_far = bin.range > kReach;
    const float change = bin.range - bin.kept;
    // What is kept is held against the first, or a slow change would go unseen.
    const bool has_drifted = std::abs(bin.kept - bin.first) >= kTolerance;
    if (bin.range > 0 && std::abs(change) < (is_far ? kFarTolerance : kTolerance) && !has_drifted) {
      if (!is_far) bin.kept += kNewest * change;
      bin.way += way;
      if (bin.sweeps < UINT8_MAX) ++bin.sweeps;
    } else {
      bin.kept = bin.first = bin.range;
      bin.way = 0;
      bin.sweeps = 0;
    }
  }
  const bool has_found = way > 0 && look_for_boxes();
  last_returns_ = returns_;
  forget_sweep();
  return has_found;
}

void OwnReturns::forget_sweep() {
  for (Bin& bin : bins_) bin.range = 0;
  returns_ = 0;
}

/// A wheel that spins claims a motion that nothing farther off shows.
bool OwnReturns::robot_moves() const {
  constexpr float kWay = 1;          // metres
  constexpr float kMostKept = 0.8F;  // level ground keeps its range, too
  std::size_t far = 0, kept = 0;
  for (const Bin& bin : bins_) {
    if (bin.range <= kReach) continue;
    ++far;
    if (bin.way >= kWay) ++kept;
  }
  return static_cast<float>(kept) < kMostKept * static_cast<float>(far);
}

bool OwnReturns::persists(const Bin& bin) const {
  return bin.way >= kLeastWay && bin.range > 0 && bin.range < kReach &&
         (to_base_ * bin.nearest).z() > kLowest;
}

bool OwnReturns::look_for_boxes() {
  if (std::ranges::none_of(bins_, [this](const Bin& bin) { return persists(bin); })) return false;
  if (!robot_moves()) return false;
  bool has_found = false;
  visited_.assign(kBins, 0);
  for (std::size_t start = 0; start < kBins; ++start) {
    if (visited_[start] != 0 || !persists(bins_[start])) continue;
    has_found |= find_around(start);
  }
  return has_found;
}

/// Puts a box around what hangs together with a bin, unless it goes on: beyond the reach, or in
/// directions that do not keep their range, as a wall beside the way does.
bool OwnReturns::find_around(std::size_t start) {
  constexpr std::size_t kFewest = 3;  // bins
  constexpr float kStep = 0.3F;       // metres from one bin to the next
  constexpr std::size_t kMostOn = 4;  // one of so many may go on: a body's border wavers
  const Eigen::Vector3d first = (to_base_ * bins_[start].nearest).cast<double>();
  BodyBox box{first, first};
  bool is_bounded = true;
  std::size_t going_on = 0;  // members
  members_.clear();
  visited_[start] = 1;
  members_.push_back(static_cast<std::uint32_t>(start));
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Bin& bin = bins_[members_[i]];
    const Eigen::Vector3d place = (to_base_ * bin.nearest).cast<double>();
    box = {box.low.cwiseMin(place), box.high.cwiseMax(place)};
    is_bounded &= bin.range < kBorder;
    bool goes_on = false;
    for_each_beside(members_[i], [&](std::size_t beside) {
      const Bin& other = bins_[beside];
      if (other.range == 0 || std::abs(other.range - bin.range) > kStep) return;
      const bool keeps_on = persists(other);
      goes_on |= !keeps_on;
      if (!keeps_on || visited_[beside] != 0) return;
      visited_[beside] = 1;
      members_.push_back(static_cast<std::uint32_t>(beside));
    });
    going_on += goes_on ? 1 : 0;
  }
  if (!is_bounded || members_.size() < kFewest || kMostOn * going_on > members_.size())
    return false;
  box.low.array() -= kRoom;
  box.high.array() += kRoom;
  for (BodyBox& other : found_) {
    const bool is_apart = (box.low.array() > other.high.array()).any() ||
                          (box.high.array() < other.low.array()).any();
    if (is_apart) continue;
    other = {other.low.cwiseMin(box.low), other.high.cwiseMax(box.high)};
    return true;
  }
  return found_.push_back(box);
}

}  // namespace scree
