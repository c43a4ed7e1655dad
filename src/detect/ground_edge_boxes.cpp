#include <algorithm>
#include <cmath>
#include <numeric>

#include "scree/detect/box_cut.hpp"
#include "scree/detect/ground_edges.hpp"
#include "scree/detect/neighbours.hpp"
#include "scree/detect/quantile.hpp"

// How the cells that were marked beyond the ground become boxes.
namespace scree {
namespace {

constexpr float kLeastLength = 0.5F;  // metres
constexpr float kLeastShadow = 2;     // metres: shorter ones are those of low bumps
constexpr float kLeastFilled = 0.5F;  // share of the strip along an edge that is marked
constexpr float kLeastWidth = 0.3F;   // of an edge's box, metres

}  // namespace

/// Collects the marked cells of one sign that hang together, small gaps bridged.
void GroundEdges::collect(std::size_t start, std::int8_t sign) {
  constexpr float kGap = 1;  // metres
  const auto reach = static_cast<std::ptrdiff_t>(std::lround(kGap / surface_->cell_size()));
  const auto columns = static_cast<std::ptrdiff_t>(surface_->columns());
  const auto rows = static_cast<std::ptrdiff_t>(surface_->rows());
  std::size_t next = cells_.size();
  is_taken_[start] = 1;
  cells_.push_back(static_cast<std::uint32_t>(start));
  for (; next < cells_.size(); ++next) {
    const auto column = static_cast<std::ptrdiff_t>(cells_[next]) % columns;
    const auto row = static_cast<std::ptrdiff_t>(cells_[next]) / columns;
    for (std::ptrdiff_t v = std::max<std::ptrdiff_t>(row - reach, 0);
         v <= std::min(row + reach, rows - 1); ++v) {
      for (std::ptrdiff_t u = std::max<std::ptrdiff_t>(column - reach, 0);
           u <= std::min(column + reach, columns - 1); ++u) {
        const auto cell = static_cast<std::size_t>(v * columns + u);
        if (is_taken_[cell] != 0 || step_[cell] * static_cast<float>(sign) <= 0) continue;
        is_taken_[cell] = 1;
        cells_.push_back(static_cast<std::uint32_t>(cell));
      }
    }
  }
}

/// Makes one edge of cells, or two where a box would hold much that is no edge: in the corner of a
/// bent one.
void GroundEdges::add_edge(std::uint32_t begin, std::uint32_t end, int depth) {
  constexpr int kMostCuts = 5;
  GroundEdge edge;
  edge.box = box_around(begin, end);
  const auto seen = static_cast<std::uint32_t>(
      std::count_if(cells_.begin() + begin, cells_.begin() + end,
                    [&](std::uint32_t cell) { return is_seen_[cell] != 0; }));
  edge.evidence = 2 * seen < end - begin ? Evidence::shadow : Evidence::edge;
  if (edge.box.length < (edge.evidence == Evidence::edge ? kLeastLength : kLeastShadow)) return;
  // Single cells in a row, as lost shots mark them, make no edge.
  const float of_whole = edge.box.length * kStrip / surface_->cell_size();
  const float of_marked = static_cast<float>(end - begin) * surface_->cell_size();
  if (of_marked < kLeastFilled * of_whole) return;
  if (depth < kMostCuts && edge.box.width > 2 * kStrip) {
    const std::uint32_t middle = cut(begin, end, edge.box);
    if (middle > begin && middle < end) {
      add_edge(begin, middle, depth + 1);
      add_edge(middle, end, depth + 1);
      return;
    }
  }
  values_.clear();
  for (std::uint32_t i = begin; i < end; ++i) {
    if (edge.evidence == Evidence::shadow || is_seen_[cells_[i]] != 0) {
      values_.push_back(step_[cells_[i]]);
    }
  }
  edge.step = quantile({values_.data(), values_.size()}, 0.5);
  edge.ground = ground_[cells_[begin]];
  edge.box.width = std::max(edge.box.width, kLeastWidth);
  edge.begin = static_cast<std::uint32_t>(places_.size());
  add_places(begin, end);
  edge.end = static_cast<std::uint32_t>(places_.size());
  if (!edges_.push_back(edge)) places_.resize(edge.begin);
}

void GroundEdges::add_places(std::uint32_t begin, std::uint32_t end) {
  const std::size_t columns = surface_->columns();
  for (std::uint32_t i = begin; i < end; ++i) {
    places_.push_back(surface_->x_of(cells_[i] % columns), surface_->y_of(cells_[i] / columns),
                      ground_[cells_[i]], 0);
  }
}

OrientedBox GroundEdges::box_around(std::uint32_t begin, std::uint32_t end) {
  const std::size_t first = places_.size();
  add_places(begin, end);
  order_.resize(places_.size() - first);
  std::iota(order_.begin(), order_.end(), static_cast<std::uint32_t>(first));
  const OrientedBox box = smallest_box(places_, {order_.data(), order_.size()});
  places_.resize(first);
  return box;
}

/// Parts cells where the boxes of both parts are smallest together. A ring, the edge of a pit,
/// stays whole.
/// @return the first of the second part; `end` where no cut is worth it
std::uint32_t GroundEdges::cut(std::uint32_t begin, std::uint32_t end, const OrientedBox& box) {
  constexpr float kMostGround = 0.3F;  // share of a box that may be ground
  constexpr float kWorthIt = 0.6F;     // share of the box's area that is left
  const std::size_t first = places_.size();
  add_places(begin, end);
  order_.resize(places_.size() - first);
  std::iota(order_.begin(), order_.end(), static_cast<std::uint32_t>(first));
  const BestCut best = best_cut(places_, {order_.data(), order_.size()}, box, 1.25F * kStrip);
  places_.resize(first);
  const bool is_worth_it = best.area < kWorthIt * area_of(box) ||
                           (std::isfinite(best.area) && ground_share(box) > kMostGround);
  if (!is_worth_it) return end;
  const std::size_t columns = surface_->columns();
  const auto middle =
      std::partition(cells_.begin() + begin, cells_.begin() + end, [&](std::uint32_t cell) {
        return best.cut.has_first(surface_->x_of(cell % columns), surface_->y_of(cell / columns));
      });
  return static_cast<std::uint32_t>(middle - cells_.begin());
}

/// Share of a box in which ground was seen.
float GroundEdges::ground_share(const OrientedBox& box) const {
  const float c = std::cos(box.yaw), s = std::sin(box.yaw), step = surface_->cell_size();
  float all = 0, ground = 0;
  for (float along = -box.length / 2; along <= box.length / 2; along += step) {
    for (float across = -box.width / 2; across <= box.width / 2; across += step) {
      ++all;
      const std::size_t cell = surface_->cell_at(box.center_x + along * c - across * s,
                                                 box.center_y + along * s + across * c);
      if (surface_->is_ground(cell)) ++ground;
    }
  }
  return ground / std::max(all, 1.0F);
}

}  // namespace scree
