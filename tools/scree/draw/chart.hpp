#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "draw/drawing.hpp"

namespace scree::cli {

/// One direction of a chart. Bounds are where it begins and ends; those of a logarithmic one are
/// above zero.
struct Axis {
  std::string label;  ///< with its unit
  double low = 0, high = 1;
  bool is_log = false;
};

/// Points joined in their order; what lies outside the axes is cut off.
struct ChartLine {
  std::string name;
  Colour colour;
  std::vector<Eigen::Vector2d> points;
  bool is_dashed = false;
  bool has_marks = false;
};

struct LineChart {
  std::string title, subtitle;
  Axis x, y;
  std::vector<ChartLine> lines;
};

/// One bar in each group; NaN where it has none.
struct BarSeries {
  std::string name;
  Colour colour;
  std::vector<double> values;
};

struct BarChart {
  std::string title, subtitle;
  Axis y;
  int decimals = 3;  ///< of the number over each bar
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
};

/// Colours that tell lines apart, also for most people who see red and green alike.
Colour series_colour(std::size_t number);
/// The colour of what the paper says.
inline constexpr Colour kPaperColour{0.55, 0.55, 0.58};

Drawing draw_chart(const LineChart& chart);
Drawing draw_chart(const BarChart& chart);

}  // namespace scree::cli
