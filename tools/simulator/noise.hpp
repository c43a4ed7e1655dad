#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scree/core/random.hpp"

namespace scree {

/// Smooth random surface of one octave: gradient noise (Perlin, SIGGRAPH 2002) over a square of
/// `size` metres about the origin, about -0.7..0.7, with bumps about `wavelength` metres apart.
class GradientNoise {
public:
  GradientNoise(Random random, double size, double wavelength);
  /// Points outside the square take the value of its edge.
  double operator()(double x, double y) const;
  /// Adds gain times the noise to a row of heights: at y, and at x, x + step, x + 2 step...
  void add_to_row(double x, double step, double y, double gain, std::span<float> row) const;

private:
  struct LatticeCell {
    std::size_t cell;
    double share;  ///< 0..1 within it
  };
  LatticeCell lattice_cell(double coordinate) const;
  struct Slope {
    double x, y;
  };
  double wavelength_, half_;
  std::size_t cells_;
  std::vector<Slope> slopes_;
};

}  // namespace scree
