#include "simulator/cloud.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {
namespace {

/// Area of the raster's cells, summed up row by row.
std::vector<double> summed_area(const Terrain& terrain) {
  const std::size_t cells = std::max<std::size_t>(terrain.vertices(), 2) - 1;
  const double edge = terrain.settings().cell;
  std::vector<double> sums;
  sums.reserve(cells * cells);
  double total = 0;
  for (std::size_t row = 0; row < cells; ++row) {
    for (std::size_t column = 0; column < cells; ++column) {
      const auto at = [&](std::size_t right, std::size_t up) {
        return static_cast<double>(terrain.vertex(column + right, row + up));
      };
      const double dx = (at(1, 0) - at(0, 0) + at(1, 1) - at(0, 1)) / (2 * edge);
      const double dy = (at(0, 1) - at(0, 0) + at(1, 1) - at(1, 0)) / (2 * edge);
      total += std::sqrt(1 + dx * dx + dy * dy);
      sums.push_back(total);
    }
  }
  return sums;
}

}  // namespace

PointCloud reconstructed_cloud(const Terrain& terrain, const CloudSettings& settings,
                               std::uint64_t seed) {
  constexpr std::uint64_t kStream = 0xC10D;
  Random random(seed, kStream);
  const std::vector<double> area = summed_area(terrain);
  const std::size_t cells = terrain.vertices() - 1;
  const auto scattered =
      static_cast<std::size_t>(settings.scattered_share * static_cast<double>(settings.points));
  PointCloud cloud(settings.points);
  for (std::size_t i = 0; i < settings.points; ++i) {
    const double drawn = random.uniform(0, area.back());
    const auto found = std::upper_bound(area.begin(), area.end() - 1, drawn) - area.begin();
    const auto cell = static_cast<std::size_t>(found);
    double x = terrain.coordinate(cell % cells) + random.uniform(0, terrain.settings().cell);
    double y = terrain.coordinate(cell / cells) + random.uniform(0, terrain.settings().cell);
    double z = terrain.height(x, y);
    const double reflectivity = terrain.reflectivity(x, y) + 3 * random.normal();
    if (i < scattered) {
      z += random.uniform(-0.5, 2.0);
    } else {
      x += settings.noise * random.normal();
      y += settings.noise * random.normal();
      z += settings.noise * random.normal();
    }
    cloud.push_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z),
                    static_cast<float>(std::clamp(std::round(reflectivity), 0.0, 255.0)));
  }
  return cloud;
}

}  // namespace scree
