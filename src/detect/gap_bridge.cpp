#include "scree/detect/gap_bridge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace scree {

std::size_t GapBridge::join(PointView cloud, std::span<const float> heights,
                            const EdgePoints& edges, std::span<std::uint32_t> labels,
                            const GroundSurface& surface, float gap) {
  constexpr float kGroundTolerance = 0.05F;
  const std::size_t cells = surface.columns() * surface.rows();
  ground_seen_.assign(cells, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (std::abs(heights[i]) > kGroundTolerance) continue;
    ground_seen_[surface.cell_at(cloud.x[i], cloud.y[i])] = 1;
  }
  std::uint32_t count = 0;
  cluster_.assign(cells, 0);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::uint32_t side = edges.height[i] > 0 ? 1 : 0;
    cluster_[surface.cell_at(edges.points.x[i], edges.points.y[i])] = 2 * labels[i] + side + 1;
    count = std::max(count, labels[i] + 1);
  }
  parent_.resize(count);
  std::iota(parent_.begin(), parent_.end(), 0U);
  const auto reach = static_cast<std::ptrdiff_t>(gap / surface.cell_size());
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (cluster_[cell] != 0) join_neighbours(cell, reach, surface);
  }

  // Numbers without gaps, in the order of the labels.
  std::uint32_t next = 0;
  for (std::uint32_t label = 0; label < count; ++label) {
    // A root is the smallest label of its tree, so it has its number already.
    const std::uint32_t top = root(label);
    parent_[label] = top == label ? next++ : parent_[top];
  }
  for (std::uint32_t& label : labels) label = parent_[label];
  return next;
}

std::uint32_t GapBridge::root(std::uint32_t label) {
  while (parent_[label] != label) label = parent_[label] = parent_[parent_[label]];
  return label;
}

void GapBridge::join_neighbours(std::size_t cell, std::ptrdiff_t reach,
                                const GroundSurface& surface) {
  const auto columns = static_cast<std::ptrdiff_t>(surface.columns());
  const auto rows = static_cast<std::ptrdiff_t>(surface.rows());
  const auto column = static_cast<std::ptrdiff_t>(cell) % columns;
  const auto row = static_cast<std::ptrdiff_t>(cell) / columns;
  for (std::ptrdiff_t v = 0; v <= std::min(reach, rows - 1 - row); ++v) {
    const std::ptrdiff_t first = std::max(v == 0 ? 1 : -reach, -column);
    for (std::ptrdiff_t u = first; u <= std::min(reach, columns - 1 - column); ++u) {
      const std::uint32_t other = cluster_[cell + static_cast<std::size_t>(v * columns + u)];
      if (other == 0 || (other - 1) % 2 != (cluster_[cell] - 1) % 2) continue;
      if (u * u + v * v > reach * reach) continue;
      const std::uint32_t a = root((cluster_[cell] - 1) / 2), b = root((other - 1) / 2);
      if (a != b && is_open(cell, u, v, surface)) parent_[std::max(a, b)] = std::min(a, b);
    }
  }
}

/// Whether no cell on the line to another one shows ground.
bool GapBridge::is_open(std::size_t from, std::ptrdiff_t columns, std::ptrdiff_t rows,
                        const GroundSurface& surface) const {
  const std::ptrdiff_t steps = std::max(std::abs(columns), std::abs(rows));
  const auto width = static_cast<std::ptrdiff_t>(surface.columns());
  for (std::ptrdiff_t i = 1; i < steps; ++i) {
    const auto nearest = [&](std::ptrdiff_t way) {
      return static_cast<std::ptrdiff_t>(
          std::lround(static_cast<double>(way * i) / static_cast<double>(steps)));
    };
    const std::ptrdiff_t there =
        static_cast<std::ptrdiff_t>(from) + nearest(rows) * width + nearest(columns);
    if (ground_seen_[static_cast<std::size_t>(there)] != 0) return false;
  }
  return true;
}

}  // namespace scree
