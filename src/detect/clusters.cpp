#include "scree/detect/clusters.hpp"

#include <algorithm>
#include <utility>

#include "scree/detect/label.hpp"

namespace scree {

Clusters::Clusters(std::size_t max_points)
    : clusters_(max_points), members_(max_points), place_(max_points) {}

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
