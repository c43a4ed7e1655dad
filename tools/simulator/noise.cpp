#include "simulator/noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

}  // namespace

GradientNoise::GradientNoise(Random random, double size, double wavelength)
    : wavelength_(wavelength),
      half_(size / 2),
      cells_(static_cast<std::size_t>(std::ceil(size / wavelength)) + 1),
      slopes_((cells_ + 1) * (cells_ + 1)) {
  for (Slope& slope : slopes_) {
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    slope = {std::cos(angle), std::sin(angle)};
  }
}

double GradientNoise::operator()(double x, double y) const {
  const double last = static_cast<double>(cells_) - 1e-9;
  const double u = std::clamp((x + half_) / wavelength_, 0.0, last);
  const double v = std::clamp((y + half_) / wavelength_, 0.0, last);
  const auto column = static_cast<std::size_t>(u);
  const auto row = static_cast<std::size_t>(v);
  const double du = u - static_cast<double>(column);
  const double dv = v - static_cast<double>(row);
  const Slope* low = &slopes_[row * (cells_ + 1) + column];
  const Slope* high = low + cells_ + 1;
  const double a = low[0].x * du + low[0].y * dv;
  const double b = low[1].x * (du - 1) + low[1].y * dv;
  const double c = high[0].x * du + high[0].y * (dv - 1);
  const double d = high[1].x * (du - 1) + high[1].y * (dv - 1);
  const double fu = fade(du);
  return std::lerp(std::lerp(a, b, fu), std::lerp(c, d, fu), fade(dv));
}

}  // namespace scree
