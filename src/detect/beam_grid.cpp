#include "scree/detect/beam_grid.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>

#include "scree/detect/neighbours.hpp"

namespace scree {
namespace {

/// The sum over the cells up to `reach` from one.
float sum_around(const FixedVector<float>& of, std::size_t cell, std::size_t reach,
                 std::size_t columns) {
  float total = 0;
  const std::size_t first = cell - reach * columns - reach;
  for (std::size_t row = first; row <= first + 2 * reach * columns; row += columns) {
    for (std::size_t near = row; near <= row + 2 * reach; ++near) total += of[near];
  }
  return total;
}

bool is_solid(const BeamCount& beams) {
  constexpr float kShare = 0.9F;
  return beams.ended >= kShare * (beams.ended + beams.passed) &&
         beams.scatter < BeamGrid::kFirmScatter * beams.ended;
}

}  // namespace

void BeamGrid::find_loose(PointView cloud, std::span<const BeamCount> beams,
                          const GroundSurface& surface, float lowest, float highest) {
  assert(beams.size() == cloud.size());
  const std::size_t cells = surface.columns() * surface.rows();
  ended_.assign(cells, 0);
  scatter_.assign(cells, 0);
  highest_.assign(cells, 0);
  loose_.assign(cells, 0);
  surface.for_each_height(cloud, [&](std::size_t i, float height) {
    if (!(height >= lowest && height <= highest)) return;
    // The raster is laid out for the points that found room; others may lie at its edge or beyond.
    const std::optional<std::size_t> cell = surface.inner_cell_at(cloud.x[i], cloud.y[i]);
    if (!cell) return;
    ended_[*cell] += beams[i].ended;
    scatter_[*cell] += beams[i].scatter;
    highest_[*cell] = std::max(highest_[*cell], height);
  });
  mark_loose(surface.columns());
}

void BeamGrid::build(PointView cloud, std::span<const BeamCount> beams,
                     const GroundSurface& surface, float lowest, float highest) {
  assert(beams.empty() || beams.size() == cloud.size());
  const std::size_t cells = surface.columns() * surface.rows();
  ended_.assign(cells, 0);
  passed_.assign(cells, 0);
  scatter_.assign(cells, 0);
  ended_share_around_.assign(cells, 1);
  solid_.assign(cells, 0);
  highest_.assign(cells, 0);
  all_ended_.assign(cells, 0);
  all_scatter_.assign(cells, 0);
  loose_.assign(cells, 0);
  if (beams.empty()) return;
  surface.for_each_height(cloud, [&](std::size_t i, float height) {
    if (!(height <= highest)) return;
    const std::optional<std::size_t> cell = surface.inner_cell_at(cloud.x[i], cloud.y[i]);
    if (!cell) return;
    all_ended_[*cell] += beams[i].ended;
    all_scatter_[*cell] += beams[i].scatter;
    if (height < lowest) return;
    ended_[*cell] += beams[i].ended;
    passed_[*cell] += beams[i].passed;
    scatter_[*cell] += beams[i].scatter;
    if (is_solid(beams[i])) solid_[*cell] += beams[i].ended;
    highest_[*cell] = std::max(highest_[*cell], height);
  });
  look_around(surface.columns());
  mark_loose(surface.columns());
}

void BeamGrid::look_around(std::size_t columns) {
  constexpr std::size_t kReach = 2;  // cells
  const std::size_t margin = kReach * columns + kReach;
  for (std::size_t cell = margin; cell + margin < ended_.size(); ++cell) {
    if (ended_[cell] == 0) continue;
    ended_share_around_[cell] = share(sum_around(ended_, cell, kReach, columns),
                                      sum_around(passed_, cell, kReach, columns));
  }
}

/// Blades scatter the ranges as far as a tuft is deep, a rock by the sensor's noise.
void BeamGrid::mark_loose(std::size_t columns) {
  // Loose is what scatters more than this share of its height. Heights are taken from metres below
  // the surface, so that the sensor's noise on low stones is not enough.
  constexpr float kLooseShare = 0.12F, kLooseBase = 0.05F;
  const std::size_t margin = columns + 1;
  for (std::size_t cell = margin; cell + margin < ended_.size(); ++cell) {
    if (ended_[cell] == 0) continue;
    const float scatter =
        sum_around(scatter_, cell, 1, columns) / sum_around(ended_, cell, 1, columns);
    loose_[cell] = scatter > kLooseShare * (highest_[cell] + kLooseBase) ? 1 : 0;
  }
  absorb_small_patches(columns);
}

/// A few firm cells beside loose ones are as loose as those, and the other way round.
void BeamGrid::absorb_small_patches(std::size_t columns) {
  constexpr std::size_t kFewest = 6;  // cells that are a patch of their own
  for (const std::uint8_t kind : {kFirm, kLoose}) {
    seen_.assign(loose_.size(), 0);
    for (std::size_t cell = 0; cell < loose_.size(); ++cell) {
      if (ended_[cell] == 0 || loose_[cell] != kind || seen_[cell] != 0) continue;
      const bool is_alone = collect_patch(cell, columns);
      if (is_alone || patch_.size() >= kFewest) continue;
      for (const std::uint32_t member : patch_) loose_[member] = kind == kFirm ? kLoose : kFirm;
    }
  }
}

/// Collects in `patch_` the cells of one kind that hang together with `start`. The raster's
/// outermost cells hold no point.
/// @return whether no cell of the other kind touches them
bool BeamGrid::collect_patch(std::size_t start, std::size_t columns) {
  bool is_alone = true;
  patch_.clear();
  const auto take = [&](std::size_t cell) {
    if (ended_[cell] == 0 || seen_[cell] != 0) return;
    if (loose_[cell] != loose_[start]) {
      is_alone = false;
      return;
    }
    seen_[cell] = 1;
    patch_.push_back(static_cast<std::uint32_t>(cell));
  };
  take(start);
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    for (const std::size_t near : neighbours(patch_[i], columns)) take(near);
  }
  return is_alone;
}

}  // namespace scree
