#include "scree/detect/enclosing_polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace scree {
namespace {

using Eigen::Vector2d;

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Above zero when the way from a over b to c turns left.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross(b - a, c - b);
}

bool is_left_of(const Vector2d& a, const Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}

/// Andrew's monotone chain in place. Returns the number of corners, which come first,
/// counter-clockwise. @pre not empty
std::size_t make_hull(std::span<Vector2d> places) {
  const auto [left, right] = std::ranges::minmax(places, is_left_of);
  const auto upper = std::partition(
      places.begin(), places.end(),
      [&, from = left, to = right](const Vector2d& place) { return turn(from, to, place) <= 0; });
  std::sort(places.begin(), upper, is_left_of);
  std::sort(upper, places.end(),
            [](const Vector2d& a, const Vector2d& b) { return is_left_of(b, a); });
  std::size_t size = 0;
  const auto drop_corners_before = [&](const Vector2d& next, std::size_t least) {
    while (size > least && turn(places[size - 2], places[size - 1], next) <= 0) --size;
  };
  for (const Vector2d& place : places) {
    const Vector2d next = place;
    drop_corners_before(next, 1);
    places[size++] = next;
  }
  drop_corners_before(places[0], 2);
  return size;
}

/// Replaces corner i and the next one by the place where the edges beside them meet, when that
/// adds no more than this area, square metres.
bool leave_out_edge(std::span<Vector2d> corners, std::size_t i, double area) {
  const std::size_t size = corners.size();
  const Vector2d &a = corners[i], &b = corners[i + 1];
  const Vector2d before = a - corners[(i + size - 1) % size], after = corners[(i + 2) % size] - b;
  const double turned = cross(before, after);
  if (turned <= 0) return false;  // they part
  const Vector2d out = cross(b - a, after) / turned * before;
  if (cross(out, b - a) / 2 > area) return false;
  corners[i] += out;
  std::move(corners.begin() + static_cast<std::ptrdiff_t>(i) + 2, corners.end(),
            corners.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  return true;
}

/// Returns how many corners are left, at most those of a ConvexPolygon.
std::size_t leave_out_edges(std::span<Vector2d> corners) {
  constexpr double kFirstArea = 1e-6;  // square metres
  std::size_t size = corners.size();
  for (double area = kFirstArea; size > ConvexPolygon::kMaxCorners && std::isfinite(area);
       area *= 2) {
    for (std::size_t i = 0; i + 1 < size && size > ConvexPolygon::kMaxCorners; ++i) {
      if (leave_out_edge(corners.first(size), i, area)) --size;
    }
  }
  return size;
}

/// The lows and highs of the corners along a direction and across it.
struct Extremes {
  Eigen::Array2d low, high;
};

Extremes extremes_along(const Vector2d& direction, std::span<const Vector2d> corners) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Extremes found{{kInf, kInf}, {-kInf, -kInf}};
  for (const Vector2d& corner : corners) {
    const Eigen::Array2d at(direction.dot(corner), cross(direction, corner));
    found.low = found.low.min(at);
    found.high = found.high.max(at);
  }
  return found;
}

/// The direction across which the hull is narrowest; it is that of an edge.
Vector2d narrowest(std::span<const Vector2d> corners) {
  Vector2d best = Vector2d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    if (edge.norm() <= 0) continue;
    const Extremes found = extremes_along(edge.normalized(), corners);
    const double width = found.high.y() - found.low.y();
    if (width >= least) continue;
    least = width;
    best = edge.normalized();
  }
  return best;
}

ConvexPolygon polygon_of(std::span<const Vector2d> corners) {
  constexpr double kLeastWidth = 0.02;  // metres
  const Vector2d along = narrowest(corners);
  const Extremes found = extremes_along(along, corners);
  ConvexPolygon polygon;
  if (corners.size() > 2 && found.high.y() - found.low.y() >= kLeastWidth) {
    for (const Vector2d& corner : corners) polygon.push_back(corner);
    return polygon;
  }
  const Eigen::Array2d middle = (found.low + found.high) / 2;
  const Eigen::Array2d half = ((found.high - found.low) / 2).max(kLeastWidth / 2);
  const Vector2d across(-along.y(), along.x());
  for (const auto& [u, v] : {std::pair{1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) {
    polygon.push_back((middle.x() + u * half.x()) * along + (middle.y() + v * half.y()) * across);
  }
  return polygon;
}

}  // namespace

ConvexPolygon enclosing_polygon(std::span<Vector2d> places) {
  if (places.empty()) return {};
  const std::size_t corners = make_hull(places);
  return polygon_of(places.first(leave_out_edges(places.first(corners))));
}

ConvexPolygon enclosing_polygon(const ConvexPolygon& a, const ConvexPolygon& b) {
  if (a.empty() || b.empty()) return {};
  std::array<Vector2d, 2 * ConvexPolygon::kMaxCorners> corners;
  const auto end = std::copy(b.begin(), b.end(), std::copy(a.begin(), a.end(), corners.begin()));
  return enclosing_polygon(std::span(corners.begin(), end));
}

ConvexPolygon EnclosingPolygons::around(PointView points, std::span<const std::uint32_t> indices) {
  places_.clear();
  for (const std::uint32_t i : indices) places_.push_back({points.x[i], points.y[i]});
  return enclosing_polygon(places_);
}

ConvexPolygon EnclosingPolygons::around(PointView points, std::uint32_t begin, std::uint32_t end) {
  places_.clear();
  for (std::uint32_t i = begin; i < end; ++i) places_.push_back({points.x[i], points.y[i]});
  return enclosing_polygon(places_);
}

}  // namespace scree
