#pragma once

#include <string>
#include <string_view>

#include "scree/config/settings.hpp"

namespace scree {

/// What a person needs to know of a key. The range is inclusive; {0, 0} where none applies.
struct Key {
  std::string_view table, name, unit;
  double low, high;
  std::string_view meaning;
  std::string_view method = {};     ///< that it tunes, as 'method = "edges"'; empty: any
  std::string_view only_with = {};  ///< the setting without which nothing reads it; empty: none
  bool is_live = true;              ///< whether method and only_with are set
};
/// As it is written in messages: table.key.
inline std::string full_name(const Key& key) {
  return std::string(key.table) + "." + std::string(key.name);
}

namespace detail {

template <class Kernel, class Visit>
void for_each_kernel_key(Kernel& kernel, Visit&& key) {
  key("kernel_spacing", kernel.spacing, "m", 0.001, 10,
      "d of the Sobel operator: distance of the eight positions around a point (paper fig. 3)");
  key("kernel_radius", kernel.radius, "m", 0.001, 10,
      "r: reach of the kernel estimate at each position (eq. 4); not equal to kernel_spacing, or "
      "rounding decides which points lie inside");
  key("kernel_bandwidth", kernel.bandwidth, "r", 0.05, 100,
      "standard deviation of the kernel in units of kernel_radius; the paper prints 2 (eq. 3)");
  key("kernel_neighbours", kernel.neighbours, "points", 1, 1000,
      "least points at each of the eight positions for a gradient: more means fewer gradients on "
      "sparse ground, and better ones");
}

/// @param key takes what a Key has, between value and meaning, and after them the condition
template <class Edges, class Visit>
void for_each_edge_key(Edges& edges, Visit&& key) {
  for_each_kernel_key(edges.kernel, key);
  key("edge_threshold", edges.threshold, "m/m", 0, 100,
      "least slope of an edge point: lower finds flatter obstacles and more slopes of the ground");
  key("suppression", edges.suppression, "", 0, 0,
      "keep only points that are steepest along their gradient (paper fig. 4)");
  const auto with_suppression = [&](auto&&... parts) {
    key(parts..., "suppression = true", edges.suppression);
  };
  with_suppression("suppression_distance", edges.suppression_distance, "m", 0.001, 10,
                   "distance of the two positions that a point is compared with");
  with_suppression("suppression_radius", edges.suppression_radius, "m", 0.001, 10,
                   "reach of the mean at each of the two positions");
  key("cluster_method", edges.clustering, "", 0, 0,
      "supervoxel clusters the centres of super-voxels (algorithm 2), euclidean the edge points "
      "themselves (algorithm 1, the baseline)");
  const auto with_supervoxels = [&](auto&&... parts) {
    key(parts..., "cluster_method = \"supervoxel\"",
        edges.clustering == EdgeClustering::supervoxel);
  };
  with_supervoxels("voxel_size", edges.voxel_size, "m", 0.001, 10,
                   "voxels that super-voxels are made of");
  with_supervoxels(
      "seed_distance", edges.seed_distance, "m", 0.001, 10,
      "Rseed: grid of the super-voxels' seeds; the paper's 0.05 needs a far denser cloud");
  with_supervoxels("reflectivity_weight", edges.reflectivity_weight, "", 0, 1000,
                   "wc of the metric D: how much a change of reflectivity parts super-voxels");
  with_supervoxels("spatial_weight", edges.spatial_weight, "", 0, 1000,
                   "ws of the metric D: compactness");
  with_supervoxels("normal_weight", edges.normal_weight, "", 0, 1000,
                   "wn of the metric D: how much a change of direction parts super-voxels");
  with_supervoxels(
      "min_block_points", edges.min_block_points, "points", 1, 100000,
      "super-voxels with fewer points are noise and go; the paper has 6, on a denser cloud");
  key("cluster_tolerance", edges.cluster_tolerance, "m", 0.001, 10,
      "centres (or edge points) closer than this belong together: larger merges close obstacles, "
      "smaller splits rims");
  key("min_cluster_size", edges.min_cluster_size, "", 1, 100000,
      "least number of super-voxels (or of edge points, with euclidean) of an obstacle");
  key("ground_inner", edges.ground_inner, "m", 0, 10,
      "the ground's height is the median of the points from this far around a cluster's box ...");
  key("ground_outer", edges.ground_outer, "m", 0.001, 20, "... to this far");
}

template <class Surface, class Visit>
void for_each_surface_key(Surface& surface, Visit&& key) {
  key("ground_cell", surface.ground_cell, "m", 0.01, 10,
      "edge of the cells of the ground's surface: smaller follows the ground closer and needs "
      "denser points");
  key("ground_points", surface.ground_points, "points", 1, 1000,
      "least mean number of points in the cells that have any; a sparser cloud gets larger cells");
  key("ground_slope", surface.ground_slope, "m/m", 0.01, 100,
      "steeper cells are no ground: lower finds flatter obstacles and more slopes of the ground");
  key("ground_tolerance", surface.ground_tolerance, "m", 0.001, 10,
      "a smooth patch this close to the continuation of the ground belongs to it");
  key("ground_trend", surface.ground_trend, "m", 0, 100,
      "the ground goes on as it runs on the whole within this distance, for clouds that have gaps; "
      "0: level. Larger spans wider gaps, smaller follows hills");
  key("body_height", surface.body_height, "m", 0, 10,
      "least height above or depth below the surface of an obstacle's points");
  for_each_kernel_key(surface.kernel, key);
  key("cluster_method", surface.clustering, "", 0, 0,
      "regions clusters the points on the raster of the ground: seen ground parts them, unseen "
      "ground does not; euclidean by their distance in the plane");
  key("saddle", surface.saddle, "", 0, 1,
      "two tops of a region are two obstacles where the saddle between them is lower than this "
      "share of the lower top, heights weighed by the beams that end there; 0: never",
      "cluster_method = \"regions\"", surface.clustering == SurfaceClustering::regions);
  key("cluster_tolerance", surface.cluster_tolerance, "m", 0.001, 10,
      "points closer than this belong together: larger merges close obstacles, smaller splits "
      "rims");
  key("min_cluster_size", surface.min_cluster_size, "points", 1, 100000,
      "least number of points of an obstacle");
}

}  // namespace detail

/// Calls visit(Key, value&) for every setting of a detector, those of the method that is not in use
/// too, with is_live false.
template <class Detect, class Visit>
void for_each_detect_key(std::string_view table, Detect& detect, Visit&& visit) {
  std::string_view method;
  bool is_used = true;
  const auto key = [&](std::string_view name, auto& value, std::string_view unit, double low,
                       double high, std::string_view meaning, std::string_view only_with = {},
                       bool is_live = true) {
    visit(Key{table, name, unit, low, high, meaning, method, is_used ? only_with : method,
              is_used && is_live},
          value);
  };
  key("method", detect.method, "", 0, 0,
      "edges is the paper's method, clusters of steep points with heights above a ring around "
      "each; surface clusters what stands above the ground's surface or lies below it");
  key("leaf_size", detect.leaf_size, "m", 0, 10,
      "the cloud is thinned to the centroid of each occupied voxel of this edge: larger is faster "
      "and smoother, smaller keeps small obstacles; 0 takes the points as they are");
  key("clearance", detect.clearance, "m", 0, 100,
      "points higher than this above the lowest of their column are passed under and go (branches, "
      "ceilings); 0 keeps all");
  method = "method = \"edges\"";
  is_used = detect.method == Method::edges;
  detail::for_each_edge_key(detect.edges, key);
  method = "method = \"surface\"";
  is_used = detect.method == Method::surface;
  detail::for_each_surface_key(detect.surface, key);
  method = {};
  is_used = true;
  key("network", detect.network, "", 0, 0, "file of the trained network's weights");
  key("min_confidence", detect.min_confidence, "", 0, 1,
      "least answer of the network for an obstacle: higher means fewer ghosts and more misses");
}

}  // namespace scree
