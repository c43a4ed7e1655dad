#pragma once

#include <array>
#include <cstddef>
#include <numbers>

namespace scree::velodyne {

struct CosSin {
  double cos = 1, sin = 0;
};

/// Series around 0, computed by the compiler, so that every machine and mathematics library has the
/// same tables. Error below 1e-14 up to half a turn.
constexpr CosSin cos_sin_degrees(double degrees) {
  const double angle = degrees * std::numbers::pi / 180.0;
  CosSin sum{0, 0};
  double term = 1;
  for (int i = 0; i < 40; i += 4) {
    sum.cos += term;
    sum.sin += (term *= angle / (i + 1));
    sum.cos -= (term *= angle / (i + 2));
    sum.sin -= (term *= angle / (i + 3));
    term *= angle / (i + 4);
  }
  return sum;
}

/// Cosine and sine of hundredths of a degree, as the wire counts them, from a table of whole
/// degrees and one of hundredths: together small enough to stay in the first cache.
class AzimuthTable {
public:
  constexpr AzimuthTable() {
    for (int i = 0; i < 360; ++i) {
      degrees_[static_cast<std::size_t>(i)] = cos_sin_degrees(i <= 180 ? i : i - 360);
    }
    for (int i = 0; i < 100; ++i) {
      hundredths_[static_cast<std::size_t>(i)] = cos_sin_degrees(i / 100.0);
    }
  }

  /// @pre azimuth below 36000
  constexpr CosSin operator[](unsigned azimuth) const {
    const CosSin& a = degrees_[azimuth / 100];
    const CosSin& b = hundredths_[azimuth % 100];
    return {a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin};
  }

private:
  std::array<CosSin, 360> degrees_{};
  std::array<CosSin, 100> hundredths_{};
};

}  // namespace scree::velodyne
