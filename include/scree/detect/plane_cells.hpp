#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "scree/core/point_cloud.hpp"
#include "scree/detect/cell.hpp"
#include "scree/detect/key_sort.hpp"
#include "scree/detect/space_cells.hpp"

namespace scree {

/// Points sorted into square cells of the horizontal plane, row by row. The points of neighbouring
/// cells of one row then lie side by side, so a neighbourhood is a few runs of memory. A walk over
/// the cells in order finds these runs by cursors that only move forward. No table is needed.
class PlaneCells {
public:
  explicit PlaneCells(std::size_t max_points);

  /// Edge of a cell, metres: a hair more than its share of the radius, as quotients are rounded.
  static float cell_size(float radius) { return radius * 1.0001F / static_cast<float>(kReach); }

  /// Sorts `cloud`, for neighbourhoods of `radius` metres.
  /// @pre finite points, none beyond reach_of_cells(cell_size(radius), max_points, 2), no more than
  /// max_points of them
  void build(PointView cloud, float radius);

  std::size_t size() const { return sort_.size(); }
  /// The sorted points.
  const PointCloud& points() const { return points_; }
  /// Index in the cloud given to build() of a sorted point.
  std::uint32_t source(std::size_t i) const { return sort_.index(i); }

  /// Calls visit(Run cell, std::span<const Run> neighbourhood) for each occupied cell; every point
  /// within the radius of build() of a point in the cell lies in the neighbourhood, and others.
  template <class Visit>
  void for_each_cell(Visit&& visit) const;

  /// Calls visit(Run) for runs that together hold every point of the rectangle, and others.
  template <class Visit>
  void for_each_run(float low_x, float high_x, float low_y, float high_y, Visit&& visit) const;

private:
  static constexpr int kReach = 3;  // cells of a radius: more fit closer and make more runs
  static constexpr std::size_t kRows = 2 * kReach + 1;

  std::uint64_t key_at(std::uint64_t row, std::uint64_t column) const {
    return row * columns_ + column;
  }
  std::uint32_t first_not_below(std::uint64_t key) const;
  std::uint32_t advance(std::uint32_t from, std::uint64_t key) const;

  float inverse_ = 1;
  CellRange column_range_, row_range_;
  std::uint64_t columns_ = 0;  // of a plane with kReach empty cells more on every side
  KeySort sort_;
  PointCloud points_;
};

template <class Visit>
void PlaneCells::for_each_cell(Visit&& visit) const {
  const auto count = static_cast<std::uint32_t>(size());
  std::array<Run, kRows> runs{};
  for (std::uint32_t begin = 0; begin < count;) {
    const std::uint64_t key = sort_.key(begin);
    std::uint32_t end = begin;
    while (end < count && sort_.key(end) == key) ++end;
    for (std::size_t k = 0; k < kRows; ++k) {
      const std::uint64_t center = key + k * columns_ - kReach * columns_;
      runs[k].begin = advance(runs[k].begin, center - kReach);
      runs[k].end = advance(std::max(runs[k].end, runs[k].begin), center + kReach + 1);
    }
    visit(Run{begin, end}, std::span<const Run>(runs));
    begin = end;
  }
}

/// The first point from one on with a key that is not below, by strides that double while they can.
inline std::uint32_t PlaneCells::advance(std::uint32_t from, std::uint64_t key) const {
  const auto count = static_cast<std::uint32_t>(size());
  std::uint32_t stride = 4;
  for (; from + stride < count && sort_.key(from + stride) < key; stride *= 2) from += stride;
  for (; stride > 4; stride /= 2) {
    if (from + stride / 2 < count && sort_.key(from + stride / 2) < key) from += stride / 2;
  }
  while (from < count && sort_.key(from) < key) ++from;
  return from;
}

template <class Visit>
void PlaneCells::for_each_run(float low_x, float high_x, float low_y, float high_y,
                              Visit&& visit) const {
  if (size() == 0) return;
  const auto clamped = [this](float value, const CellRange& range) {
    const auto low = static_cast<float>(range.low), high = static_cast<float>(range.high);
    const float cell = std::floor(value * inverse_);
    return range.offset(static_cast<std::int32_t>(cell < low ? low : cell > high ? high : cell));
  };
  const std::uint64_t first = clamped(low_x, column_range_) + kReach;
  const std::uint64_t last = clamped(high_x, column_range_) + kReach;
  const std::uint64_t last_row = clamped(high_y, row_range_) + kReach;
  for (std::uint64_t row = clamped(low_y, row_range_) + kReach; row <= last_row; ++row) {
    const Run run{first_not_below(key_at(row, first)), first_not_below(key_at(row, last) + 1)};
    if (run.begin < run.end) visit(run);
  }
}

}  // namespace scree
