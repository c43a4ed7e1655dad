#include "scree/detect/solidity.hpp"

#include <cassert>
#include <cmath>

namespace scree {

void Solidity::build(PointView cloud, std::span<const BeamCount> beams,
                     const GroundSurface& surface, float lowest, float highest) {
  assert(beams.empty() || beams.size() == cloud.size());
  const std::size_t cells = surface.columns() * surface.rows();
  ended_.assign(cells, 0);
  passed_.assign(cells, 0);
  scatter_.assign(cells, 0);
  around_.assign(cells, 1);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const float x = cloud.x[i], y = cloud.y[i];
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    const float height = cloud.z[i] - surface.height(x, y);
    if (!(height >= lowest && height <= highest)) continue;
    const std::size_t cell = surface.cell_at(x, y);
    ended_[cell] += static_cast<float>(beams[i].ended);
    passed_[cell] += static_cast<float>(beams[i].passed);
    scatter_[cell] += beams[i].scatter;
  }
  if (!beams.empty()) spread(surface.columns());
}

void Solidity::spread(std::size_t columns) {
  constexpr std::size_t kReach = 2;
  const std::size_t margin = kReach * columns + kReach;
  for (std::size_t cell = margin; cell + margin < ended_.size(); ++cell) {
    if (ended_[cell] == 0) continue;
    float ended = 0, passed = 0;
    for (std::size_t row = cell - margin; row <= cell + margin; row += columns) {
      for (std::size_t near = row; near <= row + 2 * kReach; ++near) {
        ended += ended_[near];
        passed += passed_[near];
      }
    }
    around_[cell] = share(ended, passed);
  }
}

}  // namespace scree
