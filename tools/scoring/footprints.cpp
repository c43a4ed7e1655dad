#include "scoring/footprints.hpp"

#include <algorithm>
#include <boost/geometry/algorithms/area.hpp>
#include <boost/geometry/algorithms/convex_hull.hpp>
#include <boost/geometry/algorithms/correct.hpp>
#include <boost/geometry/algorithms/distance.hpp>
#include <boost/geometry/algorithms/intersection.hpp>
#include <boost/geometry/algorithms/is_valid.hpp>
#include <boost/geometry/geometries/multi_polygon.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <limits>

namespace scree {
namespace {

namespace geometry = boost::geometry;
using Point = geometry::model::d2::point_xy<double>;
using Polygon = geometry::model::polygon<Point>;

constexpr double kLeastArea = 1e-9;  // square metres

Polygon polygon_of(const Outline& outline) {
  Polygon polygon;
  for (const Eigen::Vector2d& corner : outline) {
    polygon.outer().emplace_back(corner.x(), corner.y());
  }
  geometry::correct(polygon);  // closes it and turns it the way that the library wants
  return polygon;
}

}  // namespace

Outline uncrossed(Outline outline) {
  // A corner that stands twice in a row is how some programs close a polygon.
  outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
  while (outline.size() > 1 && outline.front() == outline.back()) outline.pop_back();
  if (outline.size() < 3) return {};
  const Polygon polygon = polygon_of(outline);
  if (geometry::is_valid(polygon)) {
    return geometry::area(polygon) < kLeastArea ? Outline() : outline;
  }
  Polygon hull;
  geometry::convex_hull(polygon, hull);
  if (geometry::area(hull) < kLeastArea) return {};
  outline.clear();
  for (const Point& corner : hull.outer()) outline.emplace_back(corner.x(), corner.y());
  outline.pop_back();
  return outline;
}

double distance_to(const Outline& polygon, const Eigen::Vector2d& point) {
  return geometry::distance(Point(point.x(), point.y()), polygon_of(polygon));
}

double intersection_over_union(const Outline& a, const Outline& b) {
  const Polygon first = polygon_of(a);
  const Polygon second = polygon_of(b);
  const double areas = geometry::area(first) + geometry::area(second);
  geometry::model::multi_polygon<Polygon> shared;
  try {
    geometry::intersection(first, second, shared);
  } catch (const geometry::exception&) {
    return 0;  // rounding made one of them cross itself: it has hardly any area
  }
  const double intersection = geometry::area(shared);
  return areas - intersection > 0 ? intersection / (areas - intersection) : 0;
}

double least_width(const Outline& polygon) {
  // One of the lines lies along an edge of the convex hull, which joins two of the corners.
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (polygon[i] == polygon[j]) continue;
      const Eigen::Vector2d along = (polygon[i] - polygon[j]).normalized();
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const Eigen::Vector2d& corner : polygon) {
        const double aside = along.x() * corner.y() - along.y() * corner.x();
        low = std::min(low, aside);
        high = std::max(high, aside);
      }
      least = std::min(least, high - low);
    }
  }
  return std::isfinite(least) ? least : 0;
}

}  // namespace scree
