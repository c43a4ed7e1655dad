#pragma once

#include <functional>
#include <string>
#include <vector>

#include "draw/drawing.hpp"
#include "scoring/footprints.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree::cli {

/// A square of ground seen from above in a part of a page, x up and y to the left, with a scale of
/// metres on two sides.
class GroundView {
public:
  /// @param area of the page, with room for the title; half_size metres from the middle to a side
  GroundView(Drawing& drawing, const Rectangle& area, double half_size, const std::string& title);

  /// @param colour_of takes the number of a point
  void points(PointView points, double pixels, const std::function<Colour(std::size_t)>& colour_of);
  void outline(const Outline& outline, Colour colour, double width);
  void box(const Obstacle& obstacle, Colour colour, double width);
  /// A label near a place, on a rim of white, where it covers no outline drawn so far and no label.
  void label(double x, double y, const std::string& text, Colour colour);

private:
  double across(double y) const {
    return plot_.x + plot_.width * (1 - (y + half_size_) / (2 * half_size_));
  }
  double down(double x) const {
    return plot_.y + plot_.height * (1 - (x + half_size_) / (2 * half_size_));
  }

  Drawing& drawing_;
  Rectangle plot_;
  double half_size_;
  std::vector<Rectangle> taken_;  // by outlines and labels
};

/// A page with room for panels of ground in columns and rows, and its title.
struct PanelPage {
  static constexpr double kPanel = 640;  ///< edge of a panel, pixels

  PanelPage(int columns, int rows, const std::string& title, const std::string& subtitle);
  Rectangle panel(int column, int row) const;

  Drawing drawing;
  /// A coloured mark with words at the foot of the page, from left to right.
  void legend(Colour colour, const std::string& text);

private:
  double legend_x_ = 40, legend_y_;
};

/// Colours that tell neighbours apart, by number.
Colour scattered_colour(std::size_t number);
/// From blue over green and yellow to red, for shares 0..1.
Colour height_colour(double share);

}  // namespace scree::cli
