#include "draw/chart.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scree::cli {
namespace {

constexpr int kWidth = 1280, kHeight = 760;
constexpr Rectangle kPlot{110, 100, 840, 560};
constexpr double kLegend = 980;  // left end
constexpr Colour kGrid{0.88, 0.89, 0.91};

/// Where a value stands between the ends of an axis, 0..1 inside.
double share(const Axis& axis, double value) {
  if (!axis.is_log) return (value - axis.low) / (axis.high - axis.low);
  return std::log(value / axis.low) / std::log(axis.high / axis.low);
}

double across(const Axis& axis, double value) {
  return kPlot.x + kPlot.width * share(axis, value);
}
double down(const Axis& axis, double value) {
  return kPlot.y + kPlot.height * (1 - share(axis, value));
}

/// Round values along an axis: whole decades, or about eight steps of 1, 2 or 5.
std::vector<double> ticks(const Axis& axis) {
  std::vector<double> all;
  if (axis.is_log) {
    for (double at = std::pow(10, std::ceil(std::log10(axis.low) - 1e-9)); at <= axis.high * 1.0001;
         at *= 10) {
      all.push_back(at);
    }
    return all;
  }
  const double rough = (axis.high - axis.low) / 8;
  double step = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {2.0, 5.0, 10.0}) {
    if (step >= rough) break;
    step = factor * std::pow(10, std::floor(std::log10(rough)));
  }
  for (double i = std::ceil(axis.low / step - 1e-9); i * step <= axis.high + 1e-9 * step; ++i) {
    all.push_back(i * step);
  }
  return all;
}

std::string tick_label(double value) {
  return fmt::format("{:g}", std::abs(value) < 1e-12 ? 0.0 : value);
}

void draw_head(Drawing& drawing, const std::string& title, const std::string& subtitle) {
  drawing.text(40, 42, title, 24, kText, true);
  drawing.text(40, 70, subtitle, 15, kFaint);
}

void draw_upward(Drawing& drawing, const std::string& label) {
  cairo_t* cairo = drawing.cairo();
  cairo_save(cairo);
  const double middle = kPlot.y + kPlot.height / 2;
  cairo_translate(cairo, 38, middle + drawing.text_width(label, 16) / 2);
  cairo_rotate(cairo, -std::acos(0.0));
  drawing.text(0, 0, label, 16, kText);
  cairo_restore(cairo);
}

void draw_y_axis(Drawing& drawing, const Axis& axis) {
  for (const double value : ticks(axis)) {
    const double y = down(axis, value);
    drawing.line(kPlot.x, y, kPlot.x + kPlot.width, y, kGrid, 1);
    const std::string label = tick_label(value);
    drawing.text(kPlot.x - 10 - drawing.text_width(label, 14), y + 5, label, 14, kFaint);
  }
  draw_upward(drawing, axis.label);
}

void draw_x_axis(Drawing& drawing, const Axis& axis) {
  for (const double value : ticks(axis)) {
    const double x = across(axis, value);
    drawing.line(x, kPlot.y, x, kPlot.y + kPlot.height, kGrid, 1);
    const std::string label = tick_label(value);
    drawing.text(x - drawing.text_width(label, 14) / 2, kPlot.y + kPlot.height + 22, label, 14,
                 kFaint);
  }
  const double middle = kPlot.x + kPlot.width / 2;
  drawing.text(middle - drawing.text_width(axis.label, 16) / 2, kPlot.y + kPlot.height + 54,
               axis.label, 16, kText);
}

void draw_line(Drawing& drawing, const LineChart& chart, const ChartLine& line) {
  cairo_t* cairo = drawing.cairo();
  drawing.set(line.colour);
  cairo_set_line_width(cairo, 2.5);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  constexpr std::array kDashes = {8.0, 6.0};
  if (line.is_dashed) cairo_set_dash(cairo, kDashes.data(), kDashes.size(), 0);
  for (const Eigen::Vector2d& point : line.points) {
    cairo_line_to(cairo, across(chart.x, point.x()), down(chart.y, point.y()));
  }
  cairo_stroke(cairo);
  cairo_set_dash(cairo, nullptr, 0, 0);
  if (!line.has_marks) return;
  for (const Eigen::Vector2d& point : line.points) {
    cairo_arc(cairo, across(chart.x, point.x()), down(chart.y, point.y()), 4.5, 0,
              4 * std::acos(0.0));
    cairo_fill(cairo);
  }
}

/// Text broken into lines that fit beside the plot.
std::vector<std::string> wrapped(Drawing& drawing, const std::string& text, double width) {
  std::vector<std::string> lines(1);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (!lines.back().empty() && drawing.text_width(longer, 15) > width) {
      lines.push_back(word);
    } else {
      lines.back() = longer;
    }
    begin = end + 1;
  }
  return lines;
}

void draw_legend_entry(Drawing& drawing, double& y, const std::string& name, Colour colour,
                       bool is_line, bool is_dashed) {
  if (is_line) {
    const double length = is_dashed ? 12 : 30;
    const double step = is_dashed ? 18 : 30;
    for (double x = 0; x < 30; x += step) {
      drawing.line(kLegend + x, y - 5, kLegend + x + length, y - 5, colour, 3);
    }
  } else {
    drawing.fill({kLegend, y - 14, 30, 18}, colour);
  }
  for (const std::string& line : wrapped(drawing, name, kWidth - kLegend - 55)) {
    drawing.text(kLegend + 42, y, line, 15, kText);
    y += 20;
  }
  y += 12;
}

/// A number over a bar, as large as the bar is wide; where that is too small to read, upward.
void draw_number(Drawing& drawing, const Rectangle& place, const std::string& number) {
  constexpr double kLargest = 15, kUpward = 13, kSmallest = 9;
  const double width = drawing.text_width(number, kLargest, true);
  const double size = std::min(kLargest, kLargest * (place.width - 3) / width);
  if (size >= kSmallest) {
    drawing.text_with_rim(place.x + (place.width - width * size / kLargest) / 2, place.y, number,
                          size, kText);
    return;
  }
  cairo_t* cairo = drawing.cairo();
  cairo_save(cairo);
  cairo_translate(cairo, place.x + place.width / 2 + 0.36 * kUpward, place.y);
  cairo_rotate(cairo, -std::acos(0.0));
  drawing.text_with_rim(0, 0, number, kUpward, kText);
  cairo_restore(cairo);
}

}  // namespace

Colour series_colour(std::size_t number) {
  constexpr std::array<Colour, 8> kColours = {{{0.00, 0.36, 0.68},
                                               {0.90, 0.45, 0.00},
                                               {0.00, 0.55, 0.40},
                                               {0.75, 0.15, 0.35},
                                               {0.45, 0.35, 0.75},
                                               {0.55, 0.40, 0.10},
                                               {0.20, 0.65, 0.85},
                                               {0.85, 0.65, 0.10}}};
  return kColours[number % kColours.size()];
}

Drawing draw_chart(const LineChart& chart) {
  Drawing drawing(kWidth, kHeight, kWhite);
  draw_head(drawing, chart.title, chart.subtitle);
  draw_y_axis(drawing, chart.y);
  draw_x_axis(drawing, chart.x);
  // Marks on the rim of the plot are not cut in half.
  drawing.clip({kPlot.x - 6, kPlot.y - 6, kPlot.width + 12, kPlot.height + 12});
  for (const ChartLine& line : chart.lines) draw_line(drawing, chart, line);
  drawing.unclip();
  drawing.outline(kPlot, kFaint, 1);
  double y = kPlot.y + 16;
  for (const ChartLine& line : chart.lines) {
    draw_legend_entry(drawing, y, line.name, line.colour, true, line.is_dashed);
  }
  return drawing;
}

Drawing draw_chart(const BarChart& chart) {
  Drawing drawing(kWidth, kHeight, kWhite);
  draw_head(drawing, chart.title, chart.subtitle);
  draw_y_axis(drawing, chart.y);
  const double group_width = kPlot.width / static_cast<double>(chart.groups.size());
  const double bar_width = 0.82 * group_width / static_cast<double>(chart.series.size());
  for (std::size_t group = 0; group < chart.groups.size(); ++group) {
    const double left = kPlot.x + group_width * static_cast<double>(group);
    const std::string& name = chart.groups[group];
    drawing.text(left + group_width / 2 - drawing.text_width(name, 15) / 2,
                 kPlot.y + kPlot.height + 24, name, 15, kText);
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      const double value = chart.series[s].values[group];
      if (std::isnan(value)) continue;
      const double x = left + 0.09 * group_width + bar_width * static_cast<double>(s);
      const double base = kPlot.y + kPlot.height;
      const double top = std::clamp(down(chart.y, value), kPlot.y, base);
      drawing.fill({x + 1, top, bar_width - 2, base - top}, chart.series[s].colour);
      draw_number(drawing, {x, top - 5, bar_width, 0},
                  fmt::format("{:.{}f}", value, chart.decimals));
    }
  }
  drawing.line(kPlot.x, kPlot.y, kPlot.x, kPlot.y + kPlot.height, kFaint, 1);
  drawing.line(kPlot.x, kPlot.y + kPlot.height, kPlot.x + kPlot.width, kPlot.y + kPlot.height,
               kFaint, 1);
  double y = kPlot.y + 16;
  for (const BarSeries& series : chart.series) {
    draw_legend_entry(drawing, y, series.name, series.colour, false, false);
  }
  return drawing;
}

}  // namespace scree::cli
