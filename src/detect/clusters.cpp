#include "scree/detect/clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scree/detect/box_cut.hpp"
#include "scree/detect/label.hpp"

namespace scree {

Clusters::Clusters(std::size_t max_points, std::size_t least_size)
    : clusters_(max_points / least_size + kMostParts), members_(max_points), place_(max_points) {}

void Clusters::gather(const CandidatePoints& edges, std::span<const std::uint32_t> labels,
                      std::span<const std::uint32_t> sizes, std::uint32_t min_size) {
  const auto taken = [&](std::uint32_t label) {
    return label != kNoLabel && sizes[label] >= min_size;
  };
  place_.assign(sizes.size(), 0);
  for (const std::uint32_t label : labels) {
    if (taken(label)) ++place_[label];
  }
  clusters_.clear();
  std::uint32_t begin = 0;
  for (std::uint32_t label = 0; label < sizes.size(); ++label) {
    const std::uint32_t points = std::exchange(place_[label], begin);
    if (points == 0) continue;
    Cluster cluster;
    cluster.begin = begin;
    cluster.end = begin += points;
    cluster.size = sizes[label];
    clusters_.push_back(cluster);
  }
  members_.resize(begin);
  for (std::uint32_t i = 0; i < labels.size(); ++i) {
    if (taken(labels[i])) members_[place_[labels[i]]++] = i;
  }
  for (Cluster& cluster : clusters_) {
    cluster.box = smallest_box(edges.points, members(cluster));
    const auto [low, high] = std::ranges::minmax(
        members(cluster), {}, [&](std::uint32_t i) { return edges.points.z[i]; });
    cluster.lowest = edges.points.z[low];
    cluster.highest = edges.points.z[high];
  }
}

void Clusters::part_around(const Eigen::Vector2f& place, PointView points, std::uint32_t min_size) {
  const std::size_t before = clusters_.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < before; ++i) {
    const Cluster whole = clusters_[i];
    if (whole.box.distances()(place.x(), place.y()) > 0) {
      clusters_[kept++] = whole;
      continue;
    }
    const float c = std::cos(whole.box.yaw), s = std::sin(whole.box.yaw);
    const auto is_left = [&](std::uint32_t k) {
      return (points.y[k] - place.y()) * c - (points.x[k] - place.x()) * s > 0;
    };
    const auto is_ahead = [&](std::uint32_t k) {
      return (points.x[k] - place.x()) * c + (points.y[k] - place.y()) * s > 0;
    };
    const auto first = members_.begin() + whole.begin, last = members_.begin() + whole.end;
    const auto middle = std::partition(first, last, is_left);
    const std::array bounds = {first, std::partition(first, middle, is_ahead), middle,
                               std::partition(middle, last, is_ahead), last};
    for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
      if (bounds[k + 1] - bounds[k] < static_cast<std::ptrdiff_t>(min_size)) continue;
      // In the direction of the whole, so that it ends where the part does.
      clusters_.push_back(part(static_cast<std::uint32_t>(bounds[k] - members_.begin()),
                               static_cast<std::uint32_t>(bounds[k + 1] - members_.begin()), points,
                               whole.box.yaw));
    }
  }
  std::copy(clusters_.begin() + before, clusters_.end(), clusters_.begin() + kept);
  clusters_.resize(kept + clusters_.size() - before);
}

void Clusters::part_bent(const CandidatePoints& points, std::uint32_t min_size) {
  constexpr float kLong = 4, kWide = 1.5F;  // metres
  for (std::size_t i = 0; i < clusters_.size();) {
    const Cluster& whole = clusters_[i];
    const bool is_above = points.height[members(whole)[0]] > 0;
    const bool may_be_bent = is_above && whole.box.length > kLong && whole.box.width > kWide;
    const std::uint32_t begin = whole.begin, end = whole.end;
    const std::uint32_t middle = may_be_bent ? cut(whole, points.points) : end;
    if (middle - begin < min_size || end - middle < min_size) {
      ++i;
      continue;
    }
    clusters_[i] = part(begin, middle, points.points);
    clusters_.push_back(part(middle, end, points.points));
  }
}

/// Parts a cluster's points where that leaves much less area.
/// @return the first of the second part; the cluster's end where it does not
std::uint32_t Clusters::cut(const Cluster& cluster, PointView points) {
  constexpr float kWorthIt = 0.5F;            // share of the box's area that is left
  constexpr float kStrip = 1;                 // metres: what an arm is wide
  constexpr std::uint32_t kMostSample = 512;  // points that tell where
  const auto indices = members(cluster);
  const auto stride = static_cast<std::uint32_t>(indices.size()) / kMostSample + 1;
  place_.clear();
  for (std::size_t i = 0; i < indices.size(); i += stride) place_.push_back(indices[i]);
  const BestCut best = best_cut(points, {place_.data(), place_.size()}, cluster.box, kStrip);
  if (best.area >= kWorthIt * area_of(cluster.box)) return cluster.end;
  const auto middle =
      std::partition(members_.begin() + cluster.begin, members_.begin() + cluster.end,
                     [&](std::uint32_t i) { return best.cut.has_first(points.x[i], points.y[i]); });
  return static_cast<std::uint32_t>(middle - members_.begin());
}

/// A part of a cluster.
/// @param yaw of its box; none: that of the smallest
Cluster Clusters::part(std::uint32_t begin, std::uint32_t end, PointView points,
                       std::optional<float> yaw) const {
  Cluster part;
  part.begin = begin;
  part.end = end;
  part.size = end - begin;
  const auto indices = members(part);
  part.box = yaw ? box_along(*yaw, points, indices) : smallest_box(points, indices);
  const auto [low, high] =
      std::ranges::minmax(indices, {}, [&](std::uint32_t i) { return points.z[i]; });
  part.lowest = points.z[low];
  part.highest = points.z[high];
  return part;
}

Features measure(const CandidatePoints& edges, std::span<const std::uint32_t> members) {
  const PointCloud& points = edges.points;
  double x = 0, y = 0, height = 0;
  float lowest = edges.height[members[0]], highest = lowest;
  for (const std::uint32_t i : members) {
    x += points.x[i];
    y += points.y[i];
    height += edges.height[i];
    lowest = std::min(lowest, edges.height[i]);
    highest = std::max(highest, edges.height[i]);
  }
  const double share = 1.0 / static_cast<double>(members.size());
  const auto axis_x = static_cast<float>(x * share), axis_y = static_cast<float>(y * share);
  float acute = 0, obtuse = 0;
  for (const std::uint32_t i : members) {
    const float along =
        edges.slope_x[i] * (axis_x - points.x[i]) + edges.slope_y[i] * (axis_y - points.y[i]);
    if (along > 0) ++acute;
    if (along < 0) ++obtuse;
  }
  Features features{};
  features[mean_height] = static_cast<float>(height * share);
  features[max_height] = highest;
  features[min_height] = lowest;
  features[acute_count] = acute;
  features[obtuse_count] = obtuse;
  return features;
}

}  // namespace scree
