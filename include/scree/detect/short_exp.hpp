#pragma once

namespace scree {

/// Takes exp(-t) as (exp(-t / 2^n))^(2^n). Only neighbours within a kernel's radius count, so t has
/// a largest value; with arguments up to 1/4 a short polynomial is exact to a float's rounding.
struct ShortExp {
  float scale = 1;  ///< 2^-n
  int squarings = 0;

  explicit ShortExp(float largest) {
    while (largest * scale > 0.25F && squarings < 24) {
      scale *= 0.5F;
      ++squarings;
    }
  }

  /// Puts the exponential in the place of an exponent, -t times `scale`: of a float, or of each of
  /// a vector of them.
  template <class Floats>
  static void replace(Floats& exponent, int squarings) {
    const Floats e = exponent;
    exponent = 1.0F + e * (1.0F + e * (0.5F + e * (1.0F / 6 + e * (1.0F / 24))));
    for (int n = 0; n < squarings; ++n) exponent *= exponent;
  }
};

}  // namespace scree
