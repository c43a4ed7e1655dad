#pragma once

#include <vector>

#include "scree/learn/sample.hpp"

namespace scree {

/// Clusters as rocks, holes and slopes might give them, without a detector: heights in metres,
/// counts that grow with size and density.
inline std::vector<Sample> stand_in_samples(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<Sample> samples(count);
  for (Sample& sample : samples) {
    sample.label = static_cast<Label>(random.index(3));
    const double height = random.uniform(0.15, 1.0);
    const double points = 30 * height * random.uniform(0.5, 20);
    const double mixed = random.uniform(0.02, 0.25);
    const double sign = sample.label == Label::negative ? -1 : 1;
    const double size = sample.label == Label::none ? random.uniform(-0.25, 0.25) : sign * height;
    const double acute = sample.label == Label::none       ? random.uniform(0.2, 0.8)
                         : sample.label == Label::positive ? 1 - mixed
                                                           : mixed;
    const double noise = 0.03 * random.normal();
    sample.features = {static_cast<float>(0.5 * size + noise),
                       static_cast<float>(std::max(size, 0.0) + noise),
                       static_cast<float>(std::min(size, 0.0) + noise),
                       static_cast<float>(static_cast<int>(points * acute)),
                       static_cast<float>(static_cast<int>(points * (1 - acute)))};
  }
  return samples;
}

}  // namespace scree
