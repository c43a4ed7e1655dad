#include "scree/detect/elevation_gradient.hpp"

#include "scree/detect/multiversion.hpp"
#include "scree/detect/short_gaussian.hpp"

namespace scree {
namespace {

/// One lane for each of the eight positions around a point: the compiler maps them to whatever
/// vectors the processor has, and the result does not depend on which.
using Lanes = float __attribute__((vector_size(32)));
using Masks = std::int32_t __attribute__((vector_size(32)));

constexpr Lanes kOffsetX = {-1, 0, 1, -1, 1, -1, 0, 1};
constexpr Lanes kOffsetY = {-1, -1, -1, 0, 0, 1, 1, 1};
/// Sobel weights 1-2-1 (eq. 1); divided by 8 d they give a slope.
constexpr Lanes kSobelX = {-1, 0, 1, -2, 2, -1, 0, 1};
constexpr Lanes kSobelY = {-1, -2, -1, 0, 0, 1, 2, 1};

float sum(Lanes lanes) {
  float total = 0;
  for (int k = 0; k < 8; ++k) total += lanes[k];
  return total;
}

/// What the inner loop needs, so that it reads registers only.
struct Kernel {
  Lanes offset_x, offset_y;
  float square;  // square of the radius, square metres
  ShortGaussian weight;
  int min_neighbours;
  float share;  // of the Sobel sum that is the slope, 1/m
};

/// The inner loop: all kernel sums of one point (eq. 4) in one pass over its neighbourhood.
SCREE_MULTIVERSION
Slope sobel(const Kernel& kernel, const PointCloud& points, std::uint32_t i,
            std::span<const Run> neighbourhood) {
  const float x = points.x[i], y = points.y[i], z = points.z[i];
  const Lanes offset_x = kernel.offset_x, offset_y = kernel.offset_y;
  Lanes weights{}, elevations{};
  Masks counts{};
  for (const Run run : neighbourhood) {
    for (std::uint32_t j = run.begin; j < run.end; ++j) {
      const Lanes dx = (points.x[j] - x) - offset_x, dy = (points.y[j] - y) - offset_y;
      const Lanes distance = dx * dx + dy * dy;
      const Masks inside = distance <= kernel.square;
      Lanes k = distance;
      kernel.weight.replace(k);
      // The bits of k where it is inside, else of zero: cheaper than a choice without AVX.
      k = reinterpret_cast<Lanes>(reinterpret_cast<Masks>(k) & inside);
      weights += k;
      elevations += k * (points.z[j] - z);
      counts -= inside;
    }
  }
  std::int32_t fewest = counts[0];
  for (int k = 1; k < 8; ++k) fewest = counts[k] < fewest ? counts[k] : fewest;
  if (fewest < kernel.min_neighbours) return {};
  const Lanes estimate = elevations / weights;
  return {sum(kSobelX * estimate) * kernel.share, sum(kSobelY * estimate) * kernel.share};
}

}  // namespace

void ElevationGradient::compute(const PlaneCells& cells, std::span<float> slope_x,
                                std::span<float> slope_y) const {
  const Kernel kernel{.offset_x = kOffsetX * spacing,
                      .offset_y = kOffsetY * spacing,
                      .square = radius * radius,
                      .weight = {radius, bandwidth},
                      .min_neighbours = min_neighbours,
                      .share = 1.0F / (8.0F * spacing)};
  const PointCloud& points = cells.points();
  cells.for_each_cell([&](Run cell, std::span<const Run> neighbourhood) {
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
      const Slope slope = sobel(kernel, points, i, neighbourhood);
      slope_x[i] = slope.x;
      slope_y[i] = slope.y;
    }
  });
}

}  // namespace scree
