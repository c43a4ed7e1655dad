#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/short_gaussian.hpp"

namespace scree {

/// The Gaussian-kernel Sobel operator (paper eq. 1-4) at the places of a raster as wide as the
/// operator's positions are apart. A place's eight positions are places, too, so that each point
/// enters a few sums once, and no pairs of points are looked at.
class GradientRaster {
public:
  explicit GradientRaster(std::size_t max_places)
      : places_(max_places), is_near_(max_places), widened_(max_places) {}

  enum class Role : std::uint8_t {
    left_out,
    counts,
    asks,  ///< counts, and its slope will be asked for
  };
  /// Sums the kernel's weights and the weighed elevations at the places around those that ask.
  /// @param points finite
  /// @param roles of each of them
  /// @param gradient where the points need more than max_places, its lengths are doubled until they
  /// do not
  void build(PointView points, std::span<const Role> roles, const ElevationGradient& gradient);

  /// Slope of the elevation at the place nearest to a point of build() that asks.
  Slope at(float x, float y) const;

private:
  struct Place {
    float weights = 0, elevations = 0;
    std::int32_t points = 0;
  };

  std::size_t index_of(std::int32_t column, std::int32_t row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void lay_out(PointView points, float spacing);
  void widen_near();
  void widen_near(std::size_t reach, std::size_t apart);
  void add(float u, float v, float z);

  float low_x_ = 0, low_y_ = 0, spacing_ = 1, inverse_ = 1;
  float radius_ = 0;  // of the kernel, in units of spacing_
  ShortGaussian weight_;
  std::int32_t min_neighbours_ = 1;
  std::int32_t columns_ = 0, rows_ = 0;
  FixedVector<Place> places_;
  /// Of each square between four places whether its points matter to one that asks.
  FixedVector<std::uint8_t> is_near_;
  FixedVector<std::uint8_t> widened_;  // scratch
};

}  // namespace scree
