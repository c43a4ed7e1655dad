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

GradientNoise::LatticeCell GradientNoise::lattice_cell(double coordinate) const {
  const double last = static_cast<double>(cells_) - 1e-9;
  const double place = std::clamp((coordinate + half_) / wavelength_, 0.0, last);
  const auto cell = static_cast<std::size_t>(place);
  return {cell, place - static_cast<double>(cell)};
}

double GradientNoise::operator()(double x, double y) const {
  const auto [column, du] = lattice_cell(x);
  const auto [row, dv] = lattice_cell(y);
  const Slope* low = &slopes_[row * (cells_ + 1) + column];
  const Slope* high = low + cells_ + 1;
  const double a = low[0].x * du + low[0].y * dv;
  const double b = low[1].x * (du - 1) + low[1].y * dv;
  const double c = high[0].x * du + high[0].y * (dv - 1);
  const double d = high[1].x * (du - 1) + high[1].y * (dv - 1);
  const double fu = fade(du);
  return std::lerp(std::lerp(a, b, fu), std::lerp(c, d, fu), fade(dv));
}

void GradientNoise::add_to_row(double x, double step, double y, double gain,
                               std::span<float> row) const {
  const auto [line, dv] = lattice_cell(y);
  const double fv = fade(dv);
  const Slope* low = &slopes_[line * (cells_ + 1)];
  const Slope* high = low + cells_ + 1;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto [column, du] = lattice_cell(x + static_cast<double>(i) * step);
    // Between two columns of slopes the noise is a mean of two straight lines.
    const double left_rise = low[column].x + fv * (high[column].x - low[column].x);
    const double left = low[column].y * dv + fv * (high[column].y * (dv - 1) - low[column].y * dv);
    const std::size_t next = column + 1;
    const double right_rise = low[next].x + fv * (high[next].x - low[next].x);
    const double right = low[next].y * dv + fv * (high[next].y * (dv - 1) - low[next].y * dv);
    const double a = left + left_rise * du;
    const double b = right + right_rise * (du - 1);
    row[i] += static_cast<float>(gain * (a + fade(du) * (b - a)));
  }
}

}  // namespace scree
