#include "simulator/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr std::size_t kSmallestBlock = 4;  // cells a side
constexpr std::size_t kBlocksABlock = 4;   // of the next smaller ones, a side

}  // namespace

RayCaster::RayCaster(const Terrain& terrain) : terrain_(terrain) {
  const std::size_t last = terrain.vertices() - 1;
  Level& small = levels_[0];
  small.blocks = (last + kSmallestBlock - 1) / kSmallestBlock;
  small.block_size = static_cast<double>(kSmallestBlock) * terrain.settings().cell;
  small.highest.assign(small.blocks * small.blocks, std::numeric_limits<float>::lowest());
  for (std::size_t block = 0; block < small.highest.size(); ++block) {
    const std::size_t row = block / small.blocks * kSmallestBlock;
    const std::size_t column = block % small.blocks * kSmallestBlock;
    for (std::size_t v = row; v <= std::min(row + kSmallestBlock, last); ++v) {
      for (std::size_t u = column; u <= std::min(column + kSmallestBlock, last); ++u) {
        small.highest[block] = std::max(small.highest[block], terrain.vertex(u, v));
      }
    }
  }
  for (std::size_t i = 1; i < levels_.size(); ++i) {
    const Level& finer = levels_[i - 1];
    Level& level = levels_[i];
    level.blocks = (finer.blocks + kBlocksABlock - 1) / kBlocksABlock;
    level.block_size = static_cast<double>(kBlocksABlock) * finer.block_size;
    level.highest.assign(level.blocks * level.blocks, std::numeric_limits<float>::lowest());
    for (std::size_t block = 0; block < finer.highest.size(); ++block) {
      const std::size_t row = block / finer.blocks / kBlocksABlock;
      const std::size_t column = block % finer.blocks / kBlocksABlock;
      float& highest = level.highest[row * level.blocks + column];
      highest = std::max(highest, finer.highest[block]);
    }
  }
  const std::vector<float>& all = levels_.back().highest;
  top_ = static_cast<double>(*std::max_element(all.begin(), all.end()));
}

std::optional<double> RayCaster::cast(const Eigen::Vector3d& origin,
                                      const Eigen::Vector3d& direction, double max_range) const {
  constexpr double kNudge = 1e-9;  // over the border into the next block
  const double half = terrain_.half_size();
  // Per axis the inverse of the direction; where it hardly moves, no border is ever reached.
  std::array<double, 2> inverse{};
  for (int axis = 0; axis < 2; ++axis) {
    const double along = direction[axis];
    inverse[static_cast<std::size_t>(axis)] = std::abs(along) > kNudge ? 1 / along : 1 / kNudge;
  }
  double t = 0;
  if (origin.z() > top_) {
    if (direction.z() >= 0) return std::nullopt;
    t = (top_ - origin.z()) / direction.z();
  }
  std::size_t coarseness = levels_.size() - 1;
  while (t < max_range) {
    const Eigen::Vector3d at = origin + t * direction;
    if (!terrain_.covers(at.x(), at.y())) return std::nullopt;
    if (at.z() > top_ && direction.z() >= 0) return std::nullopt;
    const Level& level = levels_[coarseness];
    double leave = max_range;
    std::array<std::size_t, 2> block{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double from_edge = std::max(at[static_cast<int>(axis)] + half, 0.0);
      block[axis] =
          std::min(static_cast<std::size_t>(from_edge / level.block_size), level.blocks - 1);
      const double border =
          static_cast<double>(block[axis] + (inverse[axis] > 0 ? 1 : 0)) * level.block_size;
      leave = std::min(leave, t + (border - from_edge) * inverse[axis]);
    }
    leave = std::max(leave, t) + kNudge;
    const double lowest = std::min(at.z(), origin.z() + leave * direction.z());
    if (lowest <= static_cast<double>(level.highest[block[1] * level.blocks + block[0]])) {
      if (coarseness > 0) {
        --coarseness;
        continue;
      }
      if (const auto hit = march(origin, direction, t, leave)) return hit;
    } else if (coarseness + 1 < levels_.size()) {
      ++coarseness;
    }
    t = leave;
  }
  return std::nullopt;
}

std::optional<double> RayCaster::march(const Eigen::Vector3d& origin,
                                       const Eigen::Vector3d& direction, double from,
                                       double to) const {
  const auto above = [&](double t) { return terrain_.clearance(origin + t * direction); };
  const double step = terrain_.settings().cell;
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
