#include "draw/top_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "draw/height_raster.hpp"

namespace scree::cli {
namespace {

constexpr int kPageWidth = 1400, kPageHeight = 1120;
constexpr Rectangle kGroundPlot{70, 90, 1000, 980};
constexpr double kPanel = 1105;  // left end of the legend
constexpr Colour kRobot{0.0, 0.5, 0.25};

/// The values between which all but a share of `outliers` at either end lie.
std::pair<double, double> bulk(std::span<const float> values, double outliers) {
  std::vector<float> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float value) { return std::isfinite(value); });
  if (finite.empty()) return {0, 0};
  const auto at = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), finite.begin() + rank, finite.end());
    return static_cast<double>(finite[static_cast<std::size_t>(rank)]);
  };
  return {at(outliers), at(1 - outliers)};
}

double length_of(double least) {
  for (double decade = 0.1;; decade *= 10) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * decade >= least) return factor * decade;
    }
  }
}

/// Where a point of the ground lies on the page.
class View {
public:
  View(const PointView& points, const FixedVector<Obstacle>& obstacles) {
    auto [x0, x1] = bulk(points.x, 0.03);
    auto [y0, y1] = bulk(points.y, 0.03);
    for (const Obstacle& obstacle : obstacles) {
      const double reach = obstacle.extent.head<2>().norm() / 2;
      x0 = std::min(x0, obstacle.center.x() - reach);
      x1 = std::max(x1, obstacle.center.x() + reach);
      y0 = std::min(y0, obstacle.center.y() - reach);
      y1 = std::max(y1, obstacle.center.y() + reach);
    }
    middle_x_ = (x0 + x1) / 2;
    middle_y_ = (y0 + y1) / 2;
    const double margin = 1.06;
    pixels_per_metre_ = std::min(kGroundPlot.height / (margin * std::max(1.0, x1 - x0)),
                                 kGroundPlot.width / (margin * std::max(1.0, y1 - y0)));
  }

  double across(double y) const {
    return kGroundPlot.x + kGroundPlot.width / 2 - (y - middle_y_) * pixels_per_metre_;
  }
  double down(double x) const {
    return kGroundPlot.y + kGroundPlot.height / 2 - (x - middle_x_) * pixels_per_metre_;
  }
  double pixels(double metres) const { return metres * pixels_per_metre_; }
  double low_x() const { return middle_x_ - kGroundPlot.height / 2 / pixels_per_metre_; }
  double high_x() const { return middle_x_ + kGroundPlot.height / 2 / pixels_per_metre_; }
  double low_y() const { return middle_y_ - kGroundPlot.width / 2 / pixels_per_metre_; }
  double high_y() const { return middle_y_ + kGroundPlot.width / 2 / pixels_per_metre_; }
  double grid() const { return length_of(70 / pixels_per_metre_); }

private:
  double middle_x_, middle_y_, pixels_per_metre_;
};

Colour grey(float bright) {
  return {bright, bright, bright};
}

/// The ground, lit; white where nothing is known.
void draw_ground(Drawing& drawing, const View& view, const PointView& points) {
  constexpr double kCell = 0.1;  // metres
  constexpr std::size_t kMostCells = 4'000'000;
  HeightRaster raster(kCell);
  raster.add(points, Pose());
  HeightGrid grid = raster.grid(kMostCells);
  fill_gaps(grid, 2);
  const std::vector<float> bright = hillshade(grid);
  const double size = view.pixels(grid.cell) + 0.6;  // without seams
  for (std::size_t row = 0; row < grid.rows; ++row) {
    for (std::size_t column = 0; column < grid.columns; ++column) {
      const float light = bright[row * grid.columns + column];
      if (!std::isfinite(light)) continue;
      const double x = grid.x + static_cast<double>(column + 1) * grid.cell;
      const double y = grid.y + static_cast<double>(row + 1) * grid.cell;
      drawing.fill({view.across(y), view.down(x), size, size}, grey(light));
    }
  }
}

void draw_grid(Drawing& drawing, const View& view) {
  const double step = view.grid();
  const int decimals = step < 1 ? 1 : 0;
  const auto first = [&](double low) { return static_cast<int>(std::ceil(low / step)); };
  for (int i = first(view.low_x()); i * step <= view.high_x(); ++i) {
    const double y = view.down(i * step);
    drawing.line(kGroundPlot.x, y, kGroundPlot.x + kGroundPlot.width, y, kGridOnGround,
                 i == 0 ? 2 : 1);
    const std::string label = fmt::format("{:.{}f}", i * step, decimals);
    drawing.text(kGroundPlot.x - 8 - drawing.text_width(label, 14), y + 5, label, 14, kFaint);
  }
  for (int i = first(view.low_y()); i * step <= view.high_y(); ++i) {
    const double x = view.across(i * step);
    drawing.line(x, kGroundPlot.y, x, kGroundPlot.y + kGroundPlot.height, kGridOnGround,
                 i == 0 ? 2 : 1);
    const std::string label = fmt::format("{:.{}f}", i * step, decimals);
    drawing.text(x - drawing.text_width(label, 14) / 2, kGroundPlot.y + kGroundPlot.height + 20,
                 label, 14, kFaint);
  }
}

void draw_robot(Drawing& drawing, double x, double y) {
  cairo_t* cairo = drawing.cairo();
  cairo_move_to(cairo, x, y - 15);
  cairo_line_to(cairo, x + 10, y + 11);
  cairo_line_to(cairo, x, y + 6);
  cairo_line_to(cairo, x - 10, y + 11);
  cairo_close_path(cairo);
  drawing.set(kRobot);
  cairo_fill_preserve(cairo);
  drawing.set(kWhite);
  cairo_set_line_width(cairo, 1.5);
  cairo_stroke(cairo);
}

void draw_outline(Drawing& drawing, const View& view, const Obstacle& obstacle) {
  cairo_t* cairo = drawing.cairo();
  const Colour colour = obstacle.kind == ObstacleKind::positive ? kBlue : kOrange;
  for (const Eigen::Vector2d& corner : outline_of(obstacle)) {
    cairo_line_to(cairo, view.across(corner.y()), view.down(corner.x()));
  }
  cairo_close_path(cairo);
  drawing.set({colour.red, colour.green, colour.blue, 0.18});
  cairo_fill_preserve(cairo);
  drawing.set(colour);
  cairo_set_line_width(cairo, 2.5);
  cairo_stroke(cairo);
}

Rectangle around(const View& view, const Obstacle& obstacle) {
  const double cosine = std::abs(std::cos(obstacle.yaw)), sine = std::abs(std::sin(obstacle.yaw));
  const double x = view.pixels(cosine * obstacle.extent.x() + sine * obstacle.extent.y()) / 2 + 2;
  const double y = view.pixels(sine * obstacle.extent.x() + cosine * obstacle.extent.y()) / 2 + 2;
  return {view.across(obstacle.center.y()) - y, view.down(obstacle.center.x()) - x, 2 * y, 2 * x};
}

/// Puts each label beside its box where it covers no other label and no box; one without a free
/// place is left out. Returns how many are.
int draw_labels(Drawing& drawing, const View& view, const FixedVector<Obstacle>& obstacles,
                const Rectangle& robot) {
  constexpr double kSize = 14;
  std::vector<Rectangle> taken{robot};
  for (const Obstacle& obstacle : obstacles) taken.push_back(around(view, obstacle));
  int left_out = 0;
  for (const Obstacle& obstacle : obstacles) {
    const Rectangle box = around(view, obstacle);
    const std::string label = fmt::format("{}: {:+.2f}", obstacle.id, obstacle.height);
    Rectangle place{0, 0, drawing.text_width(label, kSize, true) + 4, kSize + 2};
    const double middle_x = box.x + box.width / 2, middle_y = box.y + box.height / 2;
    bool is_free = false;
    for (int attempt = 0; attempt < 48 && !is_free; ++attempt) {
      const double angle = attempt * std::numbers::pi / 4;
      const int ring = attempt / 8;
      const double gap = 4 + 12 * ring;
      place.x =
          middle_x - place.width / 2 + std::cos(angle) * (box.width / 2 + gap + place.width / 2);
      place.y =
          middle_y - place.height / 2 - std::sin(angle) * (box.height / 2 + gap + place.height / 2);
      is_free = kGroundPlot.holds(place) &&
                std::none_of(taken.begin(), taken.end(),
                             [&](auto& other) { return place.overlaps(other); });
    }
    if (!is_free) {
      ++left_out;
      continue;
    }
    taken.push_back(place);
    const Colour colour = obstacle.kind == ObstacleKind::positive ? kBlue : kOrange;
    const double to_x = std::clamp(middle_x, place.x, place.x + place.width);
    const double to_y = std::clamp(middle_y, place.y, place.y + place.height);
    if (std::hypot(to_x - std::clamp(to_x, box.x, box.x + box.width),
                   to_y - std::clamp(to_y, box.y, box.y + box.height)) > 10) {
      drawing.line(middle_x, middle_y, to_x, to_y, colour, 1);
    }
    drawing.text_with_rim(place.x + 2, place.y + kSize - 1, label, kSize, colour);
  }
  return left_out;
}

void draw_legend(Drawing& drawing, const View& view, const PointView& points,
                 const FixedVector<Obstacle>& obstacles, double low, double high, int left_out) {
  const auto negatives =
      std::count_if(obstacles.begin(), obstacles.end(),
                    [](const Obstacle& each) { return each.kind == ObstacleKind::negative; });
  const auto positives = static_cast<std::ptrdiff_t>(obstacles.size()) - negatives;
  double y = kGroundPlot.y + 14;
  drawing.text(kPanel, y, "Obstacles", 17, kText, true);
  const auto entry = [&](Colour colour, const std::string& text) {
    y += 32;
    const Rectangle swatch{kPanel + 1, y - 15, 26, 18};
    drawing.fill(swatch, {colour.red, colour.green, colour.blue, 0.18});
    drawing.outline(swatch, colour, 2.5);
    drawing.text(kPanel + 40, y, text, 16, kText);
  };
  entry(kBlue, fmt::format("positive (rock): {}", positives));
  entry(kOrange, fmt::format("negative (hole): {}", negatives));
  y += 28;
  drawing.text(kPanel, y, "id: metres above the ground,", 14, kFaint);
  drawing.text(kPanel, y + 18, "below zero for the depth of a hole", 14, kFaint);
  y += 18;
  if (left_out > 0) {
    y += 18;
    drawing.text(kPanel, y, fmt::format("{} labels left out for lack of space", left_out), 14,
                 kFaint);
  }

  y += 52;
  drawing.text(kPanel, y, "Robot", 17, kText, true);
  draw_robot(drawing, kPanel + 14, y + 30);
  drawing.text(kPanel + 40, y + 34, "looks up (x), y is to the left", 16, kText);

  y += 84;
  drawing.text(kPanel, y, "Ground", 17, kText, true);
  drawing.text(kPanel, y + 28, fmt::format("{} points", points.size()), 15, kText);
  drawing.text(kPanel, y + 50, fmt::format("z from {:.1f} to {:.1f} m", low, high), 15, kText);
  drawing.text(kPanel, y + 78, "lit from the upper left;", 14, kFaint);
  drawing.text(kPanel, y + 96, "what is deeper than the ground", 14, kFaint);
  drawing.text(kPanel, y + 114, "around it is darker", 14, kFaint);
  drawing.text(kPanel, y + 132, "white: unknown", 14, kFaint);

  y += 180;
  const double step = view.grid();
  const double scale = view.pixels(step);
  drawing.text(kPanel, y, "Scale", 17, kText, true);
  y += 26;
  drawing.line(kPanel, y, kPanel + scale, y, kText, 2.5);
  drawing.line(kPanel, y - 6, kPanel, y + 6, kText, 2.5);
  drawing.line(kPanel + scale, y - 6, kPanel + scale, y + 6, kText, 2.5);
  drawing.text(kPanel + scale + 12, y + 5, fmt::format("{:g} m", step), 15, kText);
}

}  // namespace

Drawing draw_top_view(const PointView& points, const FixedVector<Obstacle>& obstacles,
                      const std::string& title, const std::string& subtitle) {
  Drawing drawing(kPageWidth, kPageHeight, kWhite);
  const View view(points, obstacles);
  const auto [low, high] = bulk(points.z, 0.02);
  drawing.text(kGroundPlot.x, 42, title, 24, kText, true);
  drawing.text(kGroundPlot.x, 70, subtitle, 16, kFaint);
  draw_grid(drawing, view);
  drawing.text(18, kGroundPlot.y - 8, "x [m]", 14, kFaint);
  drawing.text(kGroundPlot.x + kGroundPlot.width - 34, kGroundPlot.y + kGroundPlot.height + 40,
               "y [m]", 14, kFaint);

  drawing.clip(kGroundPlot);
  draw_ground(drawing, view, points);
  for (const Obstacle& obstacle : obstacles) draw_outline(drawing, view, obstacle);
  const double robot_x = view.across(0), robot_y = view.down(0);
  draw_robot(drawing, robot_x, robot_y);
  const int left_out = draw_labels(drawing, view, obstacles, {robot_x - 12, robot_y - 17, 24, 30});
  drawing.unclip();
  drawing.outline(kGroundPlot, kFaint, 1);
  draw_legend(drawing, view, points, obstacles, low, high, left_out);
  return drawing;
}

}  // namespace scree::cli
