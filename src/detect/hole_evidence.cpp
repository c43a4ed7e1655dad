#include "scree/detect/hole_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/core/sweep.hpp"
#include "scree/detect/neighbours.hpp"

namespace scree {
namespace {

constexpr float kBelow = 0.06F;          // metres: what lies deeper is below the ground
constexpr float kFarthestFollowed = 15;  // metres that passing beams are followed

}  // namespace

HoleEvidence::HoleEvidence(std::size_t max_cells)
    : into_(max_cells),
      through_ground_(max_cells),
      beams_below_(max_cells),
      lost_beams_(max_cells),
      lowest_beam_(max_cells),
      lowest_return_(max_cells),
      // The tiles of any raster with at least five rows and columns, which the border gives it.
      tops_(max_cells / 64 + 64),
      cells_(max_cells),
      taken_by_(max_cells),
      near_(max_cells) {}

void HoleEvidence::build(const SeenCloud& cloud, const GroundSurface& surface) {
  const std::size_t cells = surface.columns() * surface.rows();
  into_.assign(cells, 0);
  through_ground_.assign(cells, 0);
  beams_below_.assign(cells, 0);
  lost_beams_.assign(cells, 0);
  lowest_beam_.assign(cells, std::numeric_limits<float>::infinity());
  lowest_return_.assign(cells, std::numeric_limits<float>::infinity());
  taken_by_.assign(cells, 0);
  near_.assign(cells, Near::unknown);
  number_ = 0;
  knows_beams_ = !cloud.origins.empty();
  if (!knows_beams_) return;
  robot_ = cloud.robot.value_or(Eigen::Vector2f::Zero());
  reach_ = cloud.robot ? cloud.reach : std::numeric_limits<float>::infinity();
  surface.for_each_height(cloud.points, [&](std::size_t i, float height) {
    const Eigen::Vector3f point(cloud.points.x[i], cloud.points.y[i], cloud.points.z[i]);
    if (!point.allFinite()) return;
    if (height <= -kBelow) follow(cloud.origin_of(i), point, surface);
    follow_over_gap(cloud.origin_of(i), point, surface);
  });
  if (!cloud.passing.empty()) find_tops(surface);
  for (const PassingBeam& beam : cloud.passing) follow_passing(beam, surface);
}

/// Sets the highest place of each tile, seen or spanned, with the cells beside it.
void HoleEvidence::find_tops(const GroundSurface& surface) {
  const std::size_t columns = surface.columns(), rows = surface.rows();
  tile_columns_ = columns / kTile + 1;
  tops_.assign(tile_columns_ * (rows / kTile + 1), -std::numeric_limits<float>::infinity());
  for (std::size_t tile = 0; tile < tops_.size(); ++tile) {
    const std::size_t left = tile % tile_columns_ * kTile, low = tile / tile_columns_ * kTile;
    for (std::size_t row = low - std::min<std::size_t>(low, 1);
         row < std::min(low + kTile + 1, rows); ++row) {
      for (std::size_t column = left - std::min<std::size_t>(left, 1);
           column < std::min(left + kTile + 1, columns); ++column) {
        const std::size_t cell = row * columns + column;
        tops_[tile] = std::max({tops_[tile], surface.level(cell), surface.top(cell)});
      }
    }
  }
}

/// How many strides of a cell a beam surely stays within the tile of a place and above all in it.
int HoleEvidence::steps_above(const Eigen::Vector3f& place, const Eigen::Vector3f& direction,
                              const GroundSurface& surface) const {
  const float u = surface.column_of(place.x()), v = surface.row_of(place.y());
  const auto tile_u = static_cast<std::size_t>(u) / kTile;
  const auto tile_v = static_cast<std::size_t>(v) / kTile;
  const float above = place.z() - tops_[tile_v * tile_columns_ + tile_u];
  if (!(above > 0)) return 0;
  const auto steps = [](float at, std::size_t tile, float along) {
    constexpr float kNever = 1e6F;
    if (along == 0) return kNever;
    return (static_cast<float>((tile + (along > 0 ? 1 : 0)) * kTile) - at) / along;
  };
  const float down = above / (-direction.z() * surface.cell_size());
  const float least =
      std::min({steps(u, tile_u, direction.x()), steps(v, tile_v, direction.y()), down});
  constexpr float kRounding = 0.01F;  // steps
  return static_cast<int>(
      std::clamp(least - kRounding, 0.0F, kFarthestFollowed / surface.cell_size()));
}

/// Follows a beam down to the surface, and a way on below it. @pre it goes down
void HoleEvidence::follow_passing(const PassingBeam& beam, const GroundSurface& surface) {
  constexpr float kBelowFor = 4;  // metres
  const Eigen::Vector3f stride = surface.cell_size() * beam.direction;
  const auto steps = static_cast<int>(kFarthestFollowed / surface.cell_size());
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3f at = beam.origin + static_cast<float>(i) * stride;
    if (!surface.covers(at.x(), at.y())) return;
    i += steps_above(at, beam.direction, surface);
    if (at.z() > surface.height(at.x(), at.y())) {
      // It should have ended there: a shot whose return was lost.
      if (surface.top(surface.cell_at(at.x(), at.y())) > at.z() + kBelow) return;
      continue;
    }
    const float way = static_cast<float>(i) * surface.cell_size();
    const float below = std::min(beam.range - way, kBelowFor);
    const bool has_return = beam.range < kNoReturnRange / 2;  // it was turned, and rounded
    if (below > 0) mark_lost(at, at + below * beam.direction, has_return, surface);
    return;
  }
}

/// Follows a beam back from a point below the surface to where it passed that level.
void HoleEvidence::follow(const Eigen::Vector3f& origin, const Eigen::Vector3f& end,
                          const GroundSurface& surface) {
  constexpr float kClear = 0.1F;         // metres below seen ground at which a beam cannot be
  constexpr float kMostThrough = 0.25F;  // share of the way: rims are rounded
  const float step = surface.cell_size();
  const Eigen::Vector3f back = origin - end;
  const auto steps = static_cast<int>(back.head<2>().norm() / step);
  const Eigen::Vector3f stride = back / static_cast<float>(std::max(steps, 1));
  int below = 0, through = 0;
  Eigen::Vector3f at = end;
  for (int i = 0; i < steps; ++i, at += stride) {
    const float depth = surface.height(at.x(), at.y()) - at.z();
    if (depth <= 0) break;
    ++below;
    if (depth > kClear && surface.is_ground(surface.cell_at(at.x(), at.y()))) ++through;
  }
  const bool is_clean = static_cast<float>(through) <= kMostThrough * static_cast<float>(below);
  const std::size_t cell = surface.cell_at(end.x(), end.y());
  (is_clean ? into_ : through_ground_)[cell] += 1;
  if (!is_clean) return;
  at = end;
  for (int i = 0; i < below; ++i, at += stride) {
    const std::size_t passed = surface.cell_at(at.x(), at.y());
    if (surface.is_ground(passed) || !surface.has_neighbours(passed)) continue;
    if (beams_below_[passed] < UINT16_MAX) ++beams_below_[passed];
  }
}

/// Whether a place belongs to lower ground: more of it is seen around, and none above. Reflections
/// lie below seen ground, or alone.
bool HoleEvidence::is_on_floor(const Eigen::Vector3f& place, const GroundSurface& surface) {
  constexpr float kNear = 0.4F, kLevel = 0.15F;  // metres
  constexpr int kFewest = 12;                    // cells
  const float step = surface.cell_size();
  int level = 0;
  for (float dy = -kNear; dy <= kNear; dy += step) {
    for (float dx = -kNear; dx <= kNear; dx += step) {
      const auto cell = surface.inner_cell_at(place.x() + dx, place.y() + dy);
      if (!cell || surface.points_in(*cell) == 0) continue;
      const float above = surface.seen(*cell) - place.z();
      if (above > kLevel && surface.is_ground(*cell)) return false;
      if (std::abs(above) < kLevel) ++level;
    }
  }
  return level >= kFewest;
}

/// Marks the way of a beam over cells in which nothing is seen, just before where it ended: there
/// the ground lies lower. A beam that comes from below seen ground is a reflection.
void HoleEvidence::follow_over_gap(const Eigen::Vector3f& origin, const Eigen::Vector3f& end,
                                   const GroundSurface& surface) {
  constexpr float kLeastGap = 0.8F;  // metres: between the lidar's rings there are shorter ones
  constexpr float kDenseReach = 9;  // metres: farther off the lidar's rings leave gaps of their own
  constexpr int kMostRim = 4;       // cells of the gap's near side that need not be ground
  const Eigen::Vector3f back = origin - end;
  const float way = back.head<2>().norm();
  if (back.z() <= 0 || way < kLeastGap) return;
  if ((end.head<2>() - robot_).squaredNorm() > kDenseReach * kDenseReach) return;
  const Eigen::Vector3f stride = back * (surface.cell_size() / way);
  const auto most = static_cast<int>(way / surface.cell_size());
  const auto cell_after = [&](int steps) {
    const Eigen::Vector3f at = end + static_cast<float>(steps) * stride;
    return surface.inner_cell_at(at.x(), at.y());
  };
  const auto is_unseen = [&](int steps) {
    const auto cell = cell_after(steps);
    return cell && surface.points_in(*cell) == 0;
  };
  int gap = 0;
  while (gap < most && is_unseen(gap + 1)) ++gap;
  if (static_cast<float>(gap) * surface.cell_size() < kLeastGap) return;
  const auto is_ground = [&](int steps) {
    const auto cell = cell_after(steps);
    return cell && surface.is_ground(*cell);
  };
  const int last = std::min(gap + 1 + kMostRim, most);
  int rim = gap + 1;
  while (rim < last && !is_ground(rim)) ++rim;
  const auto ground = cell_after(rim);
  if (rim >= last || !ground) return;
  const float height = end.z() + static_cast<float>(rim) * stride.z();
  if (height < surface.seen(*ground) - kBelow || !is_on_floor(end, surface)) return;
  for (int i = 1; i <= gap; ++i) {
    const auto passed = cell_after(i);
    if (!passed) return;
    add_lost(*passed, end.z() + static_cast<float>(i) * stride.z(), true);
  }
}

/// @param height of a beam over a cell, z in metres
void HoleEvidence::add_lost(std::size_t cell, float height, bool has_return) {
  if (lost_beams_[cell] < UINT16_MAX) ++lost_beams_[cell];
  lowest_beam_[cell] = std::min(lowest_beam_[cell], height);
  if (has_return) lowest_return_[cell] = std::min(lowest_return_[cell], height);
}

/// Marks the way of a beam that did not end where ground was due, from there on, as far as the
/// cloud would tell of ground.
void HoleEvidence::mark_lost(const Eigen::Vector3f& from, const Eigen::Vector3f& end,
                             bool has_return, const GroundSurface& surface) {
  const Eigen::Vector3f way = end - from;
  const auto steps = static_cast<int>(way.head<2>().norm() / surface.cell_size());
  const Eigen::Vector3f stride = way / static_cast<float>(std::max(steps, 1));
  Eigen::Vector3f at = from;
  for (int i = 0; i < steps; ++i, at += stride) {
    const std::optional<std::size_t> inner = surface.inner_cell_at(at.x(), at.y());
    if (!inner || (at.head<2>() - robot_).squaredNorm() > reach_ * reach_) return;
    const std::size_t cell = *inner;
    if (surface.is_ground(cell)) {
      if (surface.height(at.x(), at.y()) - at.z() > kBelow) return;
      continue;
    }
    add_lost(cell, at.z(), has_return);
  }
}

Evidence HoleEvidence::of(std::span<const std::uint32_t> members, const CandidatePoints& points,
                          const GroundSurface& surface) {
  constexpr float kMostThrough = 0.3F, kInside = 0.3F;
  constexpr float kRim = 0.5F, kRimAlone = 0.7F;  // the latter where nothing is known of beams
  collect_cells(members, points, surface);
  float into = 0, through = 0;
  for (std::size_t i = 0; i < seen_cells_; ++i) {
    into += into_[cells_[i]];
    through += through_ground_[cells_[i]];
  }
  rim_ = rim_share(surface);
  if (knows_beams_ && through > kMostThrough * (into + through)) return Evidence::none;
  if (rim_ < (knows_beams_ ? kRim : kRimAlone)) return Evidence::none;
  return static_cast<float>(seen_cells_) >= kInside * static_cast<float>(cells_.size())
             ? Evidence::inside
             : Evidence::wall;
}

/// Collects the cells of the members, and the void that they hang together with.
void HoleEvidence::collect_cells(std::span<const std::uint32_t> members,
                                 const CandidatePoints& points, const GroundSurface& surface) {
  ++number_;
  cells_.clear();
  const auto take = [&](std::size_t cell) {
    if (taken_by_[cell] == number_) return;
    taken_by_[cell] = number_;
    cells_.push_back(static_cast<std::uint32_t>(cell));
  };
  for (const std::uint32_t i : members) {
    take(surface.cell_at(points.points.x[i], points.points.y[i]));
  }
  seen_cells_ = cells_.size();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (const std::size_t near : neighbours(cells_[i], surface.columns())) {
      if (is_void(near)) take(near);
    }
  }
  if (!knows_beams_) close_gaps(surface);
}

/// Takes cells in which nothing was seen where half of those around them are taken: a floor with
/// gaps between its points has no rim there.
void HoleEvidence::close_gaps(const GroundSurface& surface) {
  const auto is_enclosed = [&](std::size_t cell) {
    const auto around = neighbours(cell, surface.columns());
    const auto taken =
        std::ranges::count_if(around, [&](std::size_t near) { return taken_by_[near] == number_; });
    return 2 * taken >= std::ssize(around);
  };
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (const std::size_t near : neighbours(cells_[i], surface.columns())) {
      const bool is_gap = taken_by_[near] != number_ && std::isnan(surface.seen(near));
      if (!is_gap || !surface.has_neighbours(near) || !is_enclosed(near)) continue;
      taken_by_[near] = number_;
      cells_.push_back(static_cast<std::uint32_t>(near));
    }
  }
}

/// The share of the cells at the rim with ground near them.
float HoleEvidence::rim_share(const GroundSurface& surface) {
  float rim = 0, ground = 0;
  const auto is_in_hole = [&](std::size_t cell) {
    if (taken_by_[cell] == number_) return true;
    // Another piece of the same hole's floor.
    return !knows_beams_ && surface.level(cell) - surface.seen(cell) > kBelow;
  };
  for (const std::uint32_t cell : cells_) {
    const bool is_inner = std::ranges::all_of(neighbours(cell, surface.columns()), is_in_hole);
    if (is_inner) continue;
    ++rim;
    if (has_ground_near(cell, surface)) ++ground;
  }
  return ground / std::max(rim, 1.0F);
}

/// Many clusters share a void, so that a cell is asked for again and again.
bool HoleEvidence::has_ground_near(std::size_t cell, const GroundSurface& surface) {
  constexpr float kNear = 0.35F;  // metres
  if (near_[cell] != Near::unknown) return near_[cell] == Near::ground;
  // Where no beams tell, leaves that happen to lie level must not pass for ground.
  const float least_patch = knows_beams_ ? 0.0F : 1.0F;  // square metres
  const std::size_t columns = surface.columns(), rows = surface.rows();
  const auto reach = static_cast<std::size_t>(std::lround(kNear / surface.cell_size()));
  const std::size_t column = cell % columns, row = cell / columns;
  near_[cell] = Near::nothing;
  for (std::size_t v = row - std::min(row, reach); v <= std::min(row + reach, rows - 1); ++v) {
    for (std::size_t u = column - std::min(column, reach);
         u <= std::min(column + reach, columns - 1); ++u) {
      const std::size_t near = v * columns + u;
      if (!surface.is_ground(near) || surface.patch_area(near) < least_patch) continue;
      near_[cell] = Near::ground;
      return true;
    }
  }
  return false;
}

}  // namespace scree
