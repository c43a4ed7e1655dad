#include "draw/study_view.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace scree::cli {
namespace {

constexpr double kHead = 96, kFoot = 64;  // of the page, pixels

/// A full colour; the hue runs once round from 0 to 1.
Colour of_hue(double hue, double brightness) {
  const auto part = [&](double offset) {
    const double at = std::fmod(hue + offset, 1.0) * 6;
    return brightness * std::clamp(std::abs(at - 3) - 1, 0.0, 1.0);
  };
  return {part(0), part(2.0 / 3), part(1.0 / 3)};
}

}  // namespace

Colour scattered_colour(std::size_t number) {
  constexpr double kGolden = 0.618033988749895;
  constexpr std::array kBrightness = {0.85, 0.55, 0.95};
  return of_hue(std::fmod(static_cast<double>(number) * kGolden, 1.0),
                kBrightness[number % kBrightness.size()]);
}

Colour height_colour(double share) {
  return of_hue(0.68 * (1 - std::clamp(share, 0.0, 1.0)), 0.85);
}

GroundView::GroundView(Drawing& drawing, const Rectangle& area, double half_size,
                       const std::string& title)
    : drawing_(drawing),
      plot_{area.x + 44, area.y + 34, area.width - 60, area.height - 78},
      half_size_(half_size) {
  drawing.text(plot_.x, area.y + 24, title, 17, kText, true);
  const double step = half_size > 12 ? 5 : half_size > 5 ? 2 : 1;
  for (double at = -step * std::floor(half_size / step); at <= half_size; at += step) {
    const std::string text = fmt::format("{:g}", at);
    drawing.line(plot_.x, down(at), plot_.x + plot_.width, down(at), kGridOnGround, 1);
    drawing.line(across(at), plot_.y, across(at), plot_.y + plot_.height, kGridOnGround, 1);
    drawing.text(plot_.x - 6 - drawing.text_width(text, 11), down(at) + 4, text, 11, kFaint);
    drawing.text(across(at) - drawing.text_width(text, 11) / 2, plot_.y + plot_.height + 15, text,
                 11, kFaint);
  }
  drawing.text(plot_.x - 40, plot_.y - 6, "x [m]", 11, kFaint);
  drawing.text(plot_.x + plot_.width - 26, plot_.y + plot_.height + 32, "y [m]", 11, kFaint);
  drawing.outline(plot_, kFaint, 1);
}

void GroundView::points(PointView points, double pixels,
                        const std::function<Colour(std::size_t)>& colour_of) {
  drawing_.clip(plot_);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = across(static_cast<double>(points.y[i]));
    const double y = down(static_cast<double>(points.x[i]));
    drawing_.fill({x - pixels / 2, y - pixels / 2, pixels, pixels}, colour_of(i));
  }
  drawing_.unclip();
}

void GroundView::outline(const Outline& outline, Colour colour, double width) {
  cairo_t* cairo = drawing_.cairo();
  drawing_.clip(plot_);
  for (const Eigen::Vector2d& corner : outline) {
    cairo_line_to(cairo, across(corner.y()), down(corner.x()));
  }
  cairo_close_path(cairo);
  Rectangle around;
  cairo_path_extents(cairo, &around.x, &around.y, &around.width, &around.height);
  around.width -= around.x;  // the library gives the far corner
  around.height -= around.y;
  taken_.push_back(around);
  drawing_.set(colour);
  cairo_set_line_width(cairo, width);
  cairo_stroke(cairo);
  drawing_.unclip();
}

void GroundView::box(const Obstacle& obstacle, Colour colour, double width) {
  const Eigen::Vector2d ahead(std::cos(obstacle.yaw), std::sin(obstacle.yaw));
  const Eigen::Vector2d along = ahead * obstacle.extent.x() / 2;
  const Eigen::Vector2d aside = Eigen::Vector2d(-ahead.y(), ahead.x()) * obstacle.extent.y() / 2;
  const Eigen::Vector2d middle = obstacle.center.head<2>();
  outline({middle + along + aside, middle - along + aside, middle - along - aside,
           middle + along - aside},
          colour, width);
}

void GroundView::label(double x, double y, const std::string& text, Colour colour) {
  constexpr double kSize = 12;
  const double width = drawing_.text_width(text, kSize, true);
  Rectangle place;
  for (int attempt = 0; attempt < 64; ++attempt) {
    // All round, further and further away.
    const double angle = attempt * std::numbers::pi / 4;
    const int ring = attempt / 8;
    const double away = 8 + 10.0 * ring;
    place = {across(y) + std::cos(angle) * (away + width / 2) - width / 2,
             down(x) - std::sin(angle) * (away + kSize / 2) - kSize / 2, width, kSize};
    const bool is_free =
        std::ranges::none_of(taken_, [&](const Rectangle& other) { return place.overlaps(other); });
    if (is_free && plot_.holds(place)) break;
  }
  taken_.push_back(place);
  drawing_.line(across(y), down(x), std::clamp(across(y), place.x, place.x + width),
                std::clamp(down(x), place.y, place.y + kSize), colour, 1);
  drawing_.text_with_rim(place.x, place.y + kSize - 2, text, kSize, colour);
}

PanelPage::PanelPage(int columns, int rows, const std::string& title, const std::string& subtitle)
    : drawing(static_cast<int>(kPanel) * columns, static_cast<int>(kHead + kPanel * rows + kFoot),
              kWhite),
      legend_y_(kHead + kPanel * rows + 26) {
  drawing.text(40, 40, title, 24, kText, true);
  drawing.text(40, 68, subtitle, 15, kFaint);
}

Rectangle PanelPage::panel(int column, int row) const {
  return {kPanel * column, kHead + kPanel * row, kPanel, kPanel};
}

void PanelPage::legend(Colour colour, const std::string& text) {
  drawing.fill({legend_x_, legend_y_ - 13, 22, 16}, colour);
  drawing.text(legend_x_ + 30, legend_y_, text, 15, kText);
  legend_x_ += 60 + drawing.text_width(text, 15);
}

}  // namespace scree::cli
