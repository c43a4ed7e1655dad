#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "scree/core/convex_polygon.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree {

/// A convex polygon that holds all places: their hull, when that has few enough corners. Of more
/// corners those edges are left out that cost least area, and the edges beside each are drawn out
/// until they meet. Where the hull is narrower than 2 cm, a rectangle of this width takes its
/// place. Allocates nothing; the places lie in another order afterwards.
/// @pre finite places; none gives an empty polygon
ConvexPolygon enclosing_polygon(std::span<Eigen::Vector2d> places);

/// The same around two polygons; empty when one of them is.
ConvexPolygon enclosing_polygon(const ConvexPolygon& a, const ConvexPolygon& b);

/// Makes enclosing polygons of points of a cloud, in memory that is taken once.
class EnclosingPolygons {
public:
  explicit EnclosingPolygons(std::size_t max_points) : places_(max_points) {}

  /// @pre no more than max_points indices
  ConvexPolygon around(PointView points, std::span<const std::uint32_t> indices);
  /// The same around the points from `begin` on, before `end`.
  ConvexPolygon around(PointView points, std::uint32_t begin, std::uint32_t end);

private:
  FixedVector<Eigen::Vector2d> places_;
};

}  // namespace scree
