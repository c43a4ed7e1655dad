#include "simulator/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr std::size_t kBlockCells = 16;

}  // namespace

RayCaster::RayCaster(const Terrain& terrain)
    : terrain_(terrain),
      blocks_((terrain.vertices() - 1 + kBlockCells - 1) / kBlockCells),
      block_size_(static_cast<double>(kBlockCells) * terrain.settings().cell),
      highest_(blocks_ * blocks_, std::numeric_limits<float>::lowest()) {
  const std::size_t last = terrain.vertices() - 1;
  for (std::size_t row = 0; row < blocks_ * blocks_; ++row) {
    const std::size_t first_row = row / blocks_ * kBlockCells;
    const std::size_t first_column = row % blocks_ * kBlockCells;
    for (std::size_t v = first_row; v <= std::min(first_row + kBlockCells, last); ++v) {
      for (std::size_t u = first_column; u <= std::min(first_column + kBlockCells, last); ++u) {
        highest_[row] = std::max(highest_[row], terrain.vertex(u, v));
      }
    }
  }
  top_ = static_cast<double>(*std::max_element(highest_.begin(), highest_.end()));
}

std::optional<double> RayCaster::cast(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double max_range) const {
  constexpr double kNudge = 1e-9;  // over the border into the next block
  const double half = terrain_.half_size();
  double t = 0;
  while (t < max_range) {
    const Eigen::Vector3d at = origin + t * direction;
    if (!terrain_.covers(at.x(), at.y())) return std::nullopt;
    if (at.z() > top_ && direction.z() >= 0) return std::nullopt;
    double leave = max_range;
    std::size_t block[2];
    for (int axis = 0; axis < 2; ++axis) {
      const double place = std::max((at[axis] + half) / block_size_, 0.0);
      block[axis] = std::min(static_cast<std::size_t>(place), blocks_ - 1);
      const double border = static_cast<double>(block[axis] + (direction[axis] > 0 ? 1 : 0));
      if (std::abs(direction[axis]) > kNudge) {
        leave = std::min(leave, t + ((border - place) * block_size_) / direction[axis]);
      }
    }
    leave = std::max(leave, t) + kNudge;
    const double lowest = std::min(at.z(), origin.z() + leave * direction.z());
    if (lowest <= static_cast<double>(highest_[block[1] * blocks_ + block[0]])) {
      if (const auto hit = march(origin, direction, t, leave)) return hit;
    }
    t = leave;
  }
  return std::nullopt;
}

std::optional<double> RayCaster::march(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction, double from,
                                       double to) const {
  const auto above = [&](double t) {
    const Eigen::Vector3d at = origin + t * direction;
    return at.z() - terrain_.height(at.x(), at.y());
  };
  const double step = 0.5 * terrain_.settings().cell;
  double before = from;
  double above_before = above(before);
  if (above_before <= 0) return before;
  while (before < to) {
    double after = std::min(before + step, to);
    double above_after = above(after);
    if (above_after > 0) {
      before = after;
      above_before = above_after;
      continue;
    }
    const auto crossing = [&] {
      return before + (after - before) * above_before / (above_before - above_after);
    };
    for (int i = 0; i < 3; ++i) {  // within a cell the surface is nearly straight
      const double middle = crossing();
      const double above_middle = above(middle);
      (above_middle > 0 ? before : after) = middle;
      (above_middle > 0 ? above_before : above_after) = above_middle;
    }
    return crossing();
  }
  return std::nullopt;
}

}  // namespace scree
