#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "scree/core/point_cloud.hpp"
#include "scree/detect/ground_surface.hpp"

namespace scree::test {

/// Of the shipped profile for clouds.
inline constexpr GroundSurfaceSettings kGroundSettings{
    .cell_size = 0.08F,
    .cell_points = 2.15F,
    .finder = {.max_slope = 0.34F, .tolerance = 0.1F, .trend_reach = 0}};

inline bool in_square(float x, float y, float half_width) {
  return std::abs(x) < half_width && std::abs(y) < half_width;
}

/// Where clouds() puts its bump and its bowl, and how wide they are.
inline constexpr float kBumpX = 2, kBowlX = -2, kRoundRadius = 0.6F, kRoundHeight = 0.4F;

inline float ground_with_bump_and_bowl(float x, float y) {
  const auto cap = [&](float center) {
    const float distance = std::hypot(x - center, y) / kRoundRadius;
    return distance < 1 ? kRoundHeight * (1 - distance * distance) : 0.0F;
  };
  return 0.05F * std::sin(x) + cap(kBumpX) - cap(kBowlX);
}

/// Ground of 8 x 8 m with a bump at (2, 0) and a bowl at (-2, 0), scattered points, 5 mm noise.
inline PointCloud bump_and_bowl(std::size_t points, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-4, 4), reflectivity(0, 100);
  std::normal_distribution<float> noise(0, 0.005F);
  PointCloud cloud(points);
  while (cloud.size() < points) {
    const float x = place(random), y = place(random);
    cloud.push_back(x, y, ground_with_bump_and_bowl(x, y) + noise(random), reflectivity(random));
  }
  return cloud;
}

/// Points without any order in a box about the origin.
inline PointCloud scattered(std::size_t points, float half_width, float half_height,
                            std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> plane(-half_width, half_width),
      height(-half_height, half_height), reflectivity(0, 255);
  PointCloud cloud(points);
  while (cloud.size() < points) {
    cloud.push_back(plane(random), plane(random), height(random), reflectivity(random));
  }
  return cloud;
}

}  // namespace scree::test
