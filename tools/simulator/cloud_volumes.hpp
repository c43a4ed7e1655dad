#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "scree/core/random.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// Where a reconstructed cloud has points of the plants and structures that stand above a terrain's
/// ground, tufts of grass apart.
class VolumePoints {
public:
  /// Keeps a reference to the terrain.
  explicit VolumePoints(const Terrain& terrain);

  /// How much of the surface that a robot sees is theirs, square metres.
  double area() const { return area_.empty() ? 0 : area_.back(); }
  /// A point of one of them, drawn by area; none where that one is hidden.
  /// @pre area() > 0
  std::optional<Eigen::Vector3d> draw(Random& random, double& reflectivity) const;
  /// The share of the light that reaches the ground there through what stands on it.
  double light_at(double x, double y) const;

private:
  const Terrain& terrain_;
  std::vector<const Volume*> volumes_;
  std::vector<double> area_;  // each the sum of all up to it
};

}  // namespace scree
