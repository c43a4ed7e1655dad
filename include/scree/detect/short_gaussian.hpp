#pragma once

namespace scree {

/// The kernel's weight exp(-r^2 / 2 h^2), taken as (exp(-t / 2^n))^(2^n). Only neighbours within a
/// radius count, so t has a largest value; with arguments up to 1/4 a short polynomial is exact to
/// a float's rounding.
struct ShortGaussian {
  float factor = 0;  ///< of a squared distance, in the exponent
  int squarings = 0;

  ShortGaussian() = default;
  ShortGaussian(float radius, float bandwidth) {
    const float decay = 1.0F / (2.0F * bandwidth * bandwidth);
    const float largest = radius * radius * decay;
    float scale = 1;
    while (largest * scale > 0.25F && squarings < 24) {
      scale *= 0.5F;
      ++squarings;
    }
    factor = -decay * scale;
  }

  /// Puts the weight in the place of a squared distance: a float, or each of a vector of them.
  template <class Floats>
  void replace(Floats& square) const {
    const Floats t = square * factor;
    square = 1.0F + t * (1.0F + t * (0.5F + t * (1.0F / 6 + t * (1.0F / 24))));
    for (int n = 0; n < squarings; ++n) square *= square;
  }
};

}  // namespace scree
