#include "scree/detect/cluster_context.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scree/detect/quantile.hpp"

namespace scree {
namespace {

float half_height(const Features& features) {
  return std::max(features[max_height], -features[min_height]) / 2;
}

/// Whether `is` holds for a cell or one up to `reach` cells from it.
template <class Is>
bool has_near(std::size_t cell, std::size_t reach, const GroundSurface& surface, const Is& is) {
  const std::size_t columns = surface.columns(), rows = surface.rows();
  const std::size_t column = cell % columns, row = cell / columns;
  for (std::size_t v = row - std::min(row, reach); v <= std::min(row + reach, rows - 1); ++v) {
    for (std::size_t u = column - std::min(column, reach);
         u <= std::min(column + reach, columns - 1); ++u) {
      if (is(v * columns + u)) return true;
    }
  }
  return false;
}

float slope_of(const CandidatePoints& edges, std::size_t i) {
  const float x = edges.slope_x[i], y = edges.slope_y[i];
  return std::sqrt(x * x + y * y);
}

// Metres around a cluster's box: its edge, and the ground it stands on.
constexpr float kAround = 0.3F, kFurtherAround = 0.6F;

/// Counts of cells in a cluster's box and around it, by what is known of the ground there.
struct GroundAround {
  float inside = 0, unseen = 0;      ///< cells of the box
  float around = 0, ground = 0;      ///< cells up to kAround from it
  float all_ground = 0, uneven = 0;  ///< ground up to kFurtherAround, and the sum of its roughness

  void add(std::size_t cell, float distance, const GroundSurface& surface) {
    if (distance <= 0) {
      ++inside;
      if (surface.points_in(cell) == 0) ++unseen;
      return;
    }
    const bool is_ground = surface.is_ground(cell);
    if (is_ground) {
      ++all_ground;
      uneven += surface.roughness(cell);
    }
    if (distance > kAround) return;
    ++around;
    if (is_ground) ++ground;
  }

  void set(Features& features) const {
    features[unseen_share] = unseen / std::max(inside, 1.0F);
    features[ground_share] = ground / std::max(around, 1.0F);
    features[roughness] = uneven / std::max(all_ground, 1.0F);
  }
};

/// Sums over the cells around a cluster's box of what beams met there.
struct BeamsAround {
  float ended = 0, scatter = 0;  ///< up to kFurtherAround from it
  float around = 0, loose = 0;   ///< cells up to kAround from it
  float loose_height = 0;        ///< of the highest of the loose ones, metres

  void add(std::size_t cell, float distance, const BeamGrid& beams) {
    ended += beams.all_ended(cell);
    scatter += beams.all_scatter(cell);
    if (distance > kAround) return;
    ++around;
    if (!beams.is_loose(cell)) return;
    ++loose;
    loose_height = std::max(loose_height, beams.highest(cell));
  }

  void set(Features& features) const {
    features[loose_around] = loose / std::max(around, 1.0F);
    features[over_loose] = features[max_height] - loose_height;
    features[ground_scatter] = scatter / std::max(ended, 1.0F);
  }
};

}  // namespace

void ClusterContext::build(PointView cloud, const CandidatePoints& edges,
                           const GroundSurface& surface) {
  constexpr float kGroundTolerance = 0.05F;  // metres
  ground_seen_.assign(4 * surface.columns() * surface.rows(), 0);
  surface.for_each_height(cloud, [&](std::size_t i, float height) {
    if (std::abs(height) > kGroundTolerance) return;
    ground_seen_[quarter_at(cloud.x[i], cloud.y[i], surface)] = 1;
  });
  sides_.assign(surface.columns() * surface.rows(), 0);
  visited_.assign(surface.columns() * surface.rows(), 0);
  lowest_.resize(visited_.size());
  highest_.resize(visited_.size());
  steepest_.resize(visited_.size());
  number_ = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    sides_[surface.cell_at(edges.points.x[i], edges.points.y[i])] |=
        edges.height[i] > 0 ? above : below;
  }
}

std::size_t ClusterContext::quarter_at(float x, float y, const GroundSurface& surface) const {
  const float u = surface.column_of(x), v = surface.row_of(y);
  return static_cast<std::size_t>(2 * v) * 2 * surface.columns() + static_cast<std::size_t>(2 * u);
}

/// Whether the ground was seen in each of the four squares, two quarters wide, that lie diagonally
/// around the place. Beside a wall it is seen on one side only.
bool ClusterContext::is_amid_ground(float x, float y, const GroundSurface& surface) const {
  const auto row = 2 * static_cast<std::ptrdiff_t>(surface.columns());
  const std::uint8_t* const middle = ground_seen_.begin() + quarter_at(x, y, surface);
  const auto seen = [&](std::ptrdiff_t right, std::ptrdiff_t up) {
    const std::uint8_t* const near = middle + right + up * row;
    return (near[0] | near[right] | near[up * row] | near[right + up * row]) != 0;
  };
  return seen(1, 1) && seen(1, -1) && seen(-1, 1) && seen(-1, -1);
}

void ClusterContext::measure(Cluster& cluster, std::span<const std::uint32_t> members,
                             const CandidatePoints& edges, const GroundSurface& surface,
                             const BeamGrid& beams) {
  Features& features = cluster.features;
  features[box_length] = cluster.box.length;
  features[box_width] = cluster.box.width;
  measure_points(features, members, edges, surface);
  collect_cells(features, members, edges, surface);
  measure_around(features, cluster.box, surface, beams);
  measure_edge(features, surface);
  measure_solidity(features, beams);
  measure_scatter(features, beams);
}

void ClusterContext::measure_points(Features& features, std::span<const std::uint32_t> members,
                                    const CandidatePoints& edges,
                                    const GroundSurface& surface) const {
  double slopes = 0;
  float through = 0;
  for (const std::uint32_t i : members) {
    slopes += slope_of(edges, i);
    if (is_amid_ground(edges.points.x[i], edges.points.y[i], surface)) ++through;
  }
  features[steepness] = static_cast<float>(slopes / static_cast<double>(members.size()));
  features[through_share] = through / static_cast<float>(members.size());
}

/// Gathers the cluster's cells with the heights and slopes in them, for all that is measured of
/// cells, and sets the features that come from these alone.
void ClusterContext::collect_cells(Features& features, std::span<const std::uint32_t> members,
                                   const CandidatePoints& edges, const GroundSurface& surface) {
  constexpr std::size_t kRim = 2;  // cells
  ++number_;
  cells_.clear();
  float rim = 0, spread = 0;
  for (const std::uint32_t i : members) {
    const std::size_t cell = surface.cell_at(edges.points.x[i], edges.points.y[i]);
    const float height = edges.height[i], slope = slope_of(edges, i);
    if (std::exchange(visited_[cell], number_) == number_) {
      spread += std::max(lowest_[cell] - height, 0.0F) + std::max(height - highest_[cell], 0.0F);
      lowest_[cell] = std::min(lowest_[cell], height);
      highest_[cell] = std::max(highest_[cell], height);
      steepest_[cell] = std::max(steepest_[cell], slope);
      continue;
    }
    lowest_[cell] = highest_[cell] = height;
    steepest_[cell] = slope;
    cells_.push_back(static_cast<std::uint32_t>(cell));
    const std::uint8_t other = height > 0 ? below : above;
    if (has_near(cell, kRim, surface, [&](std::size_t c) { return (sides_[c] & other) != 0; })) {
      ++rim;
    }
  }
  const auto cells = static_cast<float>(cells_.size());
  features[rim_share] = rim / cells;
  features[cell_points] = static_cast<float>(members.size()) / cells;
  features[cell_spread] = spread / cells;
  values_.clear();
  for (const std::uint32_t cell : cells_) values_.push_back(steepest_[cell]);
  features[Feature::steepest] = quantile({values_.data(), values_.size()}, 0.9);
}

/// What lies in the cluster's box and around it. The walk takes steps of a cell, so a turned box
/// meets some cells twice.
void ClusterContext::measure_around(Features& features, const OrientedBox& box,
                                    const GroundSurface& surface, const BeamGrid& beams) {
  GroundAround ground;
  BeamsAround beams_around;
  const float reach = std::hypot(box.length, box.width) / 2 + kFurtherAround;
  const float step = surface.cell_size();
  const auto distance_of = box.distances();
  for (float y = box.center_y - reach; y <= box.center_y + reach; y += step) {
    for (float x = box.center_x - reach; x <= box.center_x + reach; x += step) {
      const float distance = distance_of(x, y);
      if (distance > kFurtherAround) continue;
      const std::size_t cell = surface.cell_at(x, y);
      ground.add(cell, distance, surface);
      if (distance > 0) beams_around.add(cell, distance, beams);
    }
  }
  ground.set(features);
  beams_around.set(features);
}

/// A rock's edge is nearly as high as the rock, a mound begins low.
void ClusterContext::measure_edge(Features& features, const GroundSurface& surface) {
  const auto is_ground = [&](std::size_t cell) {
    return visited_[cell] != number_ && surface.points_in(cell) > 0 && surface.is_ground(cell);
  };
  const float half = half_height(features);
  float high = 0;
  values_.clear();
  for (const std::uint32_t cell : cells_) {
    if (!has_near(cell, 1, surface, is_ground)) continue;
    const float height = std::max(highest_[cell], -lowest_[cell]);
    values_.push_back(height);
    if (height > half) ++high;
  }
  features[edge_share] = high / std::max(static_cast<float>(values_.size()), 1.0F);
  features[edge_height] = values_.empty() ? 0 : quantile({values_.data(), values_.size()}, 0.5);
}

void ClusterContext::measure_solidity(Features& features, const BeamGrid& beams) {
  constexpr float kSolid = 0.7F;
  const float half = half_height(features);
  float solid = 0, top_ended = 0, top_passed = 0;
  values_.clear();
  for (const std::uint32_t cell : cells_) {
    if (beams.ended_share(cell) >= kSolid) ++solid;
    values_.push_back(beams.ended_share_around(cell));
    if (std::max(highest_[cell], -lowest_[cell]) < half) continue;
    top_ended += beams.ended(cell);
    top_passed += beams.passed(cell);
  }
  features[solid_share] = solid / static_cast<float>(cells_.size());
  features[top_solidity] = BeamGrid::share(top_ended, top_passed);
  features[core_solidity] = quantile({values_.data(), values_.size()}, 0.75);
}

/// A rock that grass grows against has cells of both.
void ClusterContext::measure_scatter(Features& features, const BeamGrid& beams) {
  float ended = 0, firm = 0, firm_ended = 0, solid = 0, most_solid = 0, all = 0, scatter = 0;
  values_.clear();
  for (const std::uint32_t cell : cells_) {
    const float here = beams.ended(cell), mean = beams.scatter(cell) / std::max(here, 1.0F);
    values_.push_back(mean);
    ended += here;
    if (mean < BeamGrid::kFirmScatter) {
      ++firm;
      firm_ended += here;
    }
    solid += beams.solid(cell);
    most_solid = std::max(most_solid, beams.solid(cell));
    all += beams.all_ended(cell);
    scatter += beams.all_scatter(cell);
  }
  features[beam_count] = ended;
  features[range_scatter] = quantile({values_.data(), values_.size()}, 0.5);
  features[least_scatter] = quantile({values_.data(), values_.size()}, 0.25);
  features[firm_cells] = firm / static_cast<float>(cells_.size());
  features[firm_beams] = firm_ended / std::max(ended, 1.0F);
  features[solid_beams] = solid / std::max(ended, 1.0F);
  features[solid_core] = most_solid;
  features[all_beams] = all;
  features[all_scatter] = scatter / std::max(all, 1.0F);
}

}  // namespace scree
