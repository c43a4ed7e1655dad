#include "scree/detect/body_regions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scree/detect/label.hpp"
#include "scree/detect/multiversion.hpp"
#include "scree/detect/neighbours.hpp"
#include "scree/detect/union_find.hpp"

namespace scree {
namespace {

constexpr float kSolidBeams = 4;  // stopped: fewer may be chance
constexpr float kHanging = 1.3F;  // metres: a crown of leaves begins there, tables end below

/// A row of a raster of bodies before and after it grows by a cell.
struct GrowingRow {
  const std::uint8_t* state;  ///< unseen is 0
  const float* top;
  std::uint8_t* grown;
  float* grown_top;
};

/// Gives each unseen cell of a row the greatest of its neighbours' states and of the shares of
/// their tops.
/// @param columns of the raster; the first and the last are left out
template <bool kDiagonally>
SCREE_MULTIVERSION void grow_row(const GrowingRow& row, std::ptrdiff_t columns, float share) {
  const std::uint8_t* __restrict const state = row.state;
  const float* __restrict const top = row.top;
  std::uint8_t* __restrict const grown = row.grown;
  float* __restrict const grown_top = row.grown_top;
  for (std::ptrdiff_t i = 1; i + 1 < columns; ++i) {
    std::uint8_t greatest = std::max(std::max(state[i - 1], state[i + 1]),
                                     std::max(state[i - columns], state[i + columns]));
    if constexpr (kDiagonally) {
      greatest =
          std::max(greatest, std::max(std::max(state[i - columns - 1], state[i - columns + 1]),
                                      std::max(state[i + columns - 1], state[i + columns + 1])));
    }
    grown[i] = state[i] == 0 ? greatest : state[i];
  }
  for (std::ptrdiff_t i = 1; i + 1 < columns; ++i) {
    float highest =
        std::max(std::max(top[i - 1], top[i + 1]), std::max(top[i - columns], top[i + columns]));
    if constexpr (kDiagonally) {
      highest = std::max(highest, std::max(std::max(top[i - columns - 1], top[i - columns + 1]),
                                           std::max(top[i + columns - 1], top[i + columns + 1])));
    }
    grown_top[i] = state[i] == 0 ? std::max(top[i], share * highest) : top[i];
  }
}

}  // namespace

BodyRegions::BodyRegions(std::size_t max_points, std::size_t max_cells)
    : state_(max_cells),
      grown_(max_cells),
      top_(max_cells),
      grown_top_(max_cells),
      order_(max_cells),
      parent_(max_cells),
      number_(max_cells),
      labels_(max_points),
      sizes_(max_points) {}

void BodyRegions::label(const CandidatePoints& bodies, const GroundSurface& surface,
                        const BeamGrid& solidity, const BodyRegionSettings& settings) {
  columns_ = surface.columns();
  labels_.assign(bodies.size(), kNoLabel);
  sizes_.clear();
  const auto steps = static_cast<int>(std::lround(settings.tolerance / 2 / surface.cell_size()));
  for (const Side side : {Side::above, Side::below}) {
    const auto is_here = [side](float height) { return is_on(side, height); };
    if (std::ranges::none_of(bodies.height, is_here)) continue;
    mark(bodies, side, surface, solidity);
    for (int step = 0; step < steps; ++step) {
      // To the sides and to the corners by turns: nearly a circle. Tops fall off in even steps.
      const auto left = static_cast<float>(steps - step);
      grow(step % 2 != 0, left / (left + 1));
    }
    join(settings.saddle);
    number(bodies, side, surface);
  }
}

void BodyRegions::mark(const CandidatePoints& bodies, Side side, const GroundSurface& surface,
                       const BeamGrid& solidity) {
  const std::size_t cells = columns_ * surface.rows();
  state_.resize(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    state_[cell] = surface.points_in(cell) > 0 ? clear : unseen;
  }
  top_.assign(cells, 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_on(side, bodies.height[i])) continue;
    const std::size_t cell = surface.cell_at(bodies.points.x[i], bodies.points.y[i]);
    const State state = bodies.height[i] > kHanging                      ? hanging
                        : side == Side::above && solidity.is_loose(cell) ? loose
                                                                         : firm;
    state_[cell] = std::max(state_[cell], state);
    // Holes have no tops: their floors are seldom seen, and what is seen of a wall has any depth.
    const float share = solidity.solid(cell) >= kSolidBeams ? 1.0F : solidity.ended_share(cell);
    top_[cell] = std::max(top_[cell], bodies.height[i] * (share * share));
  }
}

/// Every unseen cell becomes what a neighbour is, a body before anything else, and of bodies
/// the firm one.
/// @param share of the neighbour's top that it gets
void BodyRegions::grow(bool diagonally, float share) {
  grown_.resize(state_.size());
  grown_top_.resize(state_.size());
  std::ranges::copy(state_, grown_.begin());
  std::ranges::copy(top_, grown_top_.begin());
  const auto columns = static_cast<std::ptrdiff_t>(columns_);
  for (std::size_t first = columns_; first + columns_ < state_.size(); first += columns_) {
    const GrowingRow row{state_.data() + first, top_.data() + first, grown_.data() + first,
                         grown_top_.data() + first};
    if (diagonally) {
      grow_row<true>(row, columns, share);
    } else {
      grow_row<false>(row, columns, share);
    }
  }
  std::swap(state_, grown_);
  std::swap(top_, grown_top_);
}

/// Lets the regions rise out of a falling flood: a cell joins those that it touches, and where two
/// meet they become one unless both rise well above that place.
void BodyRegions::join(float saddle) {
  constexpr float kHighest = 65, kStep = 0.001F, kLeastRise = 0.06F;  // metres
  order_.clear();
  for (std::size_t cell = 0; cell < state_.size(); ++cell) {
    if (state_[cell] < hanging) continue;
    order_.push(static_cast<std::uint64_t>(std::max(kHighest - top_[cell], 0.0F) / kStep), cell);
  }
  order_.sort();
  parent_.assign(state_.size(), kNoLabel);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::uint32_t cell = order_.index(i);
    parent_[cell] = cell;
    for (const std::size_t other : neighbours(cell, columns_)) {
      if (parent_[other] == kNoLabel || state_[other] != state_[cell]) continue;
      std::uint32_t higher = root_of(parent_, cell),
                    lower = root_of(parent_, static_cast<std::uint32_t>(other));
      if (top_[higher] < top_[lower]) std::swap(higher, lower);
      const bool both_rise =
          top_[lower] - top_[cell] > kLeastRise && top_[cell] < saddle * top_[lower];
      if (!both_rise) parent_[lower] = higher;
    }
  }
}

void BodyRegions::number(const CandidatePoints& bodies, Side side, const GroundSurface& surface) {
  number_.assign(state_.size(), kNoLabel);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!is_on(side, bodies.height[i])) continue;
    const std::size_t cell = surface.cell_at(bodies.points.x[i], bodies.points.y[i]);
    std::uint32_t& number = number_[root_of(parent_, static_cast<std::uint32_t>(cell))];
    if (number == kNoLabel) {
      number = static_cast<std::uint32_t>(sizes_.size());
      sizes_.push_back(0);
    }
    labels_[i] = number;
    ++sizes_[number];
  }
}

}  // namespace scree
