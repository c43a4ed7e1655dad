#include "scree/detect/gradient_raster.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace scree {

void GradientRaster::build(PointView points, std::span<const Role> roles,
                           const ElevationGradient& gradient) {
  lay_out(points, gradient.spacing);
  radius_ = gradient.radius / gradient.spacing;
  weight_ = {radius_, gradient.bandwidth / gradient.spacing};
  min_neighbours_ = gradient.min_neighbours;
  places_.assign(index_of(0, rows_), {});
  const auto u_of = [&](std::size_t i) { return (points.x[i] - low_x_) * inverse_; };
  const auto v_of = [&](std::size_t i) { return (points.y[i] - low_y_) * inverse_; };
  const auto square_of = [&](float u, float v) {
    return index_of(static_cast<std::int32_t>(u), static_cast<std::int32_t>(v));
  };
  is_near_.assign(places_.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (roles[i] == Role::asks) is_near_[square_of(u_of(i), v_of(i))] = 1;
  }
  widen_near();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (roles[i] == Role::left_out) continue;
    const float u = u_of(i), v = v_of(i);
    if (is_near_[square_of(u, v)] != 0) add(u, v, points.z[i]);
  }
}

/// From the squares with points that ask to all whose points are within the kernel's radius of one
/// of the nine places around such a point: those at the corners of its square, and beside them. A
/// row may go on at the other end of the raster: a few squares too many.
void GradientRaster::widen_near() {
  const auto reach = static_cast<std::size_t>(radius_) + 2;
  widen_near(reach, 1);
  widen_near(reach, static_cast<std::size_t>(columns_));
}

void GradientRaster::widen_near(std::size_t reach, std::size_t apart) {
  widened_.copy_from(is_near_);
  for (std::size_t away = apart; away <= reach * apart; away += apart) {
    for (std::size_t i = away; i < is_near_.size(); ++i) {
      widened_[i] |= is_near_[i - away];
      widened_[i - away] |= is_near_[i];
    }
  }
  std::swap(widened_, is_near_);
}

/// Two places lie beyond every point, so that every point's nearest place has its eight positions.
void GradientRaster::lay_out(PointView points, float spacing) {
  constexpr float kBorder = 2;
  const PlaneBounds bounds = bounds_of(points);
  const auto places = [&](float low, float high) {
    return std::floor(high / spacing_) - std::floor(low / spacing_) + 1 + 2 * kBorder;
  };
  float columns = 0, rows = 0;
  for (spacing_ = spacing;; spacing_ *= 2) {
    columns = places(bounds.low_x, bounds.high_x);
    rows = places(bounds.low_y, bounds.high_y);
    if (columns * rows <= static_cast<float>(places_.capacity())) break;
  }
  columns_ = static_cast<std::int32_t>(columns);
  rows_ = static_cast<std::int32_t>(rows);
  inverse_ = 1 / spacing_;
  low_x_ = (std::floor(bounds.low_x * inverse_) - kBorder) * spacing_;
  low_y_ = (std::floor(bounds.low_y * inverse_) - kBorder) * spacing_;
}

/// @param u, v place of the point on the raster
void GradientRaster::add(float u, float v, float z) {
  const auto first = [this](float at) {
    return at < radius_ ? 0 : static_cast<std::int32_t>(at - radius_) + 1;
  };
  const auto last = [this](float at, std::int32_t count) {
    return std::min(static_cast<std::int32_t>(at + radius_), count - 1);
  };
  const std::int32_t left = first(u), right = last(u, columns_), top = last(v, rows_);
  for (std::int32_t row = first(v); row <= top; ++row) {
    const float dy = static_cast<float>(row) - v;
    for (std::int32_t column = left; column <= right; ++column) {
      const float dx = static_cast<float>(column) - u;
      const float square = dx * dx + dy * dy;
      if (square > radius_ * radius_) continue;
      float weight = square;
      weight_.replace(weight);
      Place& place = places_[index_of(column, row)];
      place.weights += weight;
      place.elevations += weight * z;
      ++place.points;
    }
  }
}

Slope GradientRaster::at(float x, float y) const {
  constexpr float kHalf = 0.5F;  // rounds to the nearest place
  const auto column = static_cast<std::int32_t>((x - low_x_) * inverse_ + kHalf);
  const auto row = static_cast<std::int32_t>((y - low_y_) * inverse_ + kHalf);
  const Place* const middle = places_.data() + index_of(column, row);
  const std::ptrdiff_t step = columns_;
  float rise_x = 0, rise_y = 0;
  for (std::ptrdiff_t v = -1; v <= 1; ++v) {
    for (std::ptrdiff_t u = -1; u <= 1; ++u) {
      if (u == 0 && v == 0) continue;
      const Place& place = middle[v * step + u];
      if (place.points < min_neighbours_) return {};
      const float elevation = place.elevations / place.weights;
      // Sobel weights 1-2-1 (eq. 1); divided by 8 d they give a slope.
      rise_x += static_cast<float>(u * (v == 0 ? 2 : 1)) * elevation;
      rise_y += static_cast<float>(v * (u == 0 ? 2 : 1)) * elevation;
    }
  }
  const float share = 0.125F * inverse_;
  return {rise_x * share, rise_y * share};
}

}  // namespace scree
