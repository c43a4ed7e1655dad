#include "scree/terrain/moving_points.hpp"

#include <algorithm>
#include <limits>

namespace scree {
namespace {

constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();

enum State : std::uint8_t { empty, seeded, taken, moving };

}  // namespace

MovingPoints::MovingPoints(std::size_t max_points)
    : first_(kNone),
      next_(max_points),
      low_(kNone),
      high_(kNone),
      state_(kNone),
      queue_(kNone),
      members_(max_points),
      begin_(max_points + 1) {}

std::size_t MovingPoints::cell_of(float x, float y) const {
  constexpr float kHalf = kCell * kCells / 2;
  const auto column = static_cast<std::int32_t>((x + kHalf) / kCell);
  const auto row = static_cast<std::int32_t>((y + kHalf) / kCell);
  constexpr auto kLast = static_cast<std::int32_t>(kCells) - 1;
  // The outermost cells stay empty, so that each has its neighbours.
  if (column < 1 || row < 1 || column >= kLast || row >= kLast) return kNone;
  return static_cast<std::size_t>(row) * kCells + static_cast<std::size_t>(column);
}

void MovingPoints::find(DeskewedSweep& sweep, const Pose& pose, const FreeSpace& free_space,
                        float reach) {
  constexpr std::size_t kFewest = 6;  // points
  sweep.is_moving.assign(sweep.points.size(), 0);
  members_.clear();
  begin_.clear();
  begin_.push_back(0);
  if (!seed(sweep, pose, free_space, reach)) return;
  for (std::size_t cell = 0; cell < kNone; ++cell) {
    if (state_[cell] != seeded) continue;
    const std::size_t begin = members_.size();
    collect(cell);
    const std::span members(members_.data() + begin, members_.size() - begin);
    if (members.size() >= kFewest && is_solid(sweep, members)) {
      begin_.push_back(static_cast<std::uint32_t>(members_.size()));
      for (const std::uint32_t each : queue_) state_[each] = moving;
    } else {
      members_.resize(begin);
    }
  }
  if (size() > 0) mark(sweep);
}

/// Finds the cells with points where nothing was, and something that stands up. False for none.
bool MovingPoints::seed(const DeskewedSweep& sweep, const Pose& pose, const FreeSpace& free_space,
                        float reach) {
  const Eigen::Matrix3f rotation = pose.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = pose.translation.cast<float>();
  first_.assign(kNone, kEnd);
  next_.assign(sweep.points.size(), kEnd);
  state_.assign(kNone, empty);
  low_.assign(kNone, std::numeric_limits<float>::max());
  high_.assign(kNone, std::numeric_limits<float>::lowest());
  bool is_any = false;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f in_base(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    if (in_base.squaredNorm() > reach * reach || sweep.is_isolated[i] != 0) continue;
    const std::size_t cell = cell_of(in_base.x(), in_base.y());
    if (cell == kNone) continue;
    low_[cell] = std::min(low_[cell], in_base.z());
    high_[cell] = std::max(high_[cell], in_base.z());
    if (!free_space.is_clear(rotation * in_base + translation)) continue;
    next_[i] = first_[cell];
    first_[cell] = static_cast<std::uint32_t>(i);
    state_[cell] = seeded;
    is_any = true;
  }
  if (!is_any) return false;
  is_any = false;
  for (std::size_t cell = 0; cell < kNone; ++cell) {
    if (state_[cell] != seeded) continue;
    if (!stands_up(cell)) state_[cell] = empty;
    is_any |= state_[cell] == seeded;
  }
  return is_any;
}

/// Ground comes into view where nothing was seen before, too: but a ring of the lidar on it is
/// flat.
bool MovingPoints::stands_up(std::size_t cell) const {
  constexpr float kLeastHeight = 0.25F;  // metres
  float low = low_[cell], high = high_[cell];
  for_each_beside(cell, [&](std::size_t beside) {
    low = std::min(low, low_[beside]);
    high = std::max(high, high_[beside]);
  });
  return high - low >= kLeastHeight;
}

/// Marks what stands in the cells of moving things or beside them.
void MovingPoints::mark(DeskewedSweep& sweep) const {
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const std::size_t cell = cell_of(sweep.points.x[i], sweep.points.y[i]);
    if (cell == kNone) continue;
    bool is_moving = state_[cell] == moving;
    for_each_beside(cell, [&](std::size_t beside) { is_moving |= state_[beside] == moving; });
    sweep.is_moving[i] = is_moving ? 1 : 0;
  }
}

/// Collects the points of cells that hang together.
void MovingPoints::collect(std::size_t start) {
  queue_.clear();
  queue_.push_back(static_cast<std::uint32_t>(start));
  state_[start] = taken;
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const std::size_t cell = queue_[i];
    for (std::uint32_t point = first_[cell]; point != kEnd; point = next_[point]) {
      members_.push_back(point);
    }
    for_each_beside(cell, [&](std::size_t beside) {
      if (state_[beside] != seeded) return;
      state_[beside] = taken;
      queue_.push_back(static_cast<std::uint32_t>(beside));
    });
  }
}

/// Whether most beams that come to the middle of a thing end there. Dust and leaves let them pass.
bool MovingPoints::is_solid(const DeskewedSweep& sweep,
                            std::span<const std::uint32_t> members) const {
  constexpr float kBehind = 0.4F;  // metres: what ends farther behind it has passed
  constexpr float kMargin = 0.05F;
  const auto point = [&](std::uint32_t i) {
    return Eigen::Vector3f(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
  };
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
  for (const std::uint32_t i : members) {
    sum += point(i);
    low = std::min(low, point(i).z());
    high = std::max(high, point(i).z());
  }
  const Eigen::Vector3f middle = sum / static_cast<float>(members.size());
  const Eigen::Vector2f view = (middle - sweep.origins[members[0]]).head<2>().normalized();
  float half = 0;
  for (const std::uint32_t i : members) {
    const Eigen::Vector2f off = (point(i) - middle).head<2>();
    half = std::max(half, std::abs(off.x() * view.y() - off.y() * view.x()));
  }
  const float core = std::max(half / 2, kMargin);
  std::size_t ended = 0, passed = 0;
  const auto look = [&](const Eigen::Vector3f& origin, const Eigen::Vector3f& end) {
    const Eigen::Vector3f beam = end - origin;
    const Eigen::Vector2f way = beam.head<2>(), to = (middle - origin).head<2>();
    const float length = way.squaredNorm();
    const float share = to.dot(way) / length;  // of the beam, at its nearest
    if (share <= 0) return;
    if (std::abs(to.x() * way.y() - to.y() * way.x()) > core * std::sqrt(length)) return;
    const float z = origin.z() + share * beam.z();
    if (z < low + kMargin || z > high - kMargin) return;
    const float behind = (1 - share) * std::sqrt(length);
    if (behind > kBehind + half) ++passed;
    if (std::abs(behind) <= kBehind + half) ++ended;
  };
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    look(sweep.origins[i], point(static_cast<std::uint32_t>(i)));
  }
  for (const EmptyBeam& beam : sweep.empty) look(beam.origin, beam.end);
  return ended > passed;
}

}  // namespace scree
