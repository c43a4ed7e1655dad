#include "scree/publish/jsonl.hpp"

#include <charconv>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string_view>
#include <type_traits>

namespace scree {
namespace {

template <class Number>
void append(std::string& text, Number number) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (!std::isfinite(number)) {
      text += "null";
      return;
    }
  }
  char digits[32];  // the longest double has 24 characters
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  text.append(digits, end);
}

void append(std::string& text, std::initializer_list<double> numbers) {
  std::string_view separator = "[";
  for (const double number : numbers) {
    text += separator;
    append(text, number);
    separator = ", ";
  }
  text += ']';
}

void append(std::string& text, const Eigen::Vector3d& vector) {
  append(text, {vector.x(), vector.y(), vector.z()});
}

void append(std::string& text, const ConvexPolygon& polygon) {
  std::string_view separator = "[";
  for (const Eigen::Vector2d& corner : polygon) {
    text += separator;
    append(text, {corner.x(), corner.y()});
    separator = ", ";
  }
  text += ']';
}

void append(std::string& text, const Obstacle& obstacle) {
  text += "{\"id\": ";
  append(text, obstacle.id);
  text += ", \"kind\": \"";
  text += name(obstacle.kind);
  text += "\", \"confidence\": ";
  append(text, obstacle.confidence);
  text += ", \"center\": ";
  append(text, obstacle.center);
  text += ", \"extent\": ";
  append(text, obstacle.extent);
  text += ", \"yaw\": ";
  append(text, obstacle.yaw);
  text += ", \"height\": ";
  append(text, obstacle.height);
  text += ", \"points\": ";
  append(text, obstacle.points);
  if (obstacle.evidence != Evidence::none) {
    text += ", \"evidence\": \"";
    text += name(obstacle.evidence);
    text += '"';
  }
  if (obstacle.footprint.has_area()) {
    text += ", \"footprint\": ";
    append(text, obstacle.footprint);
  }
  text += '}';
}

void append(std::string& text, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  text += "{\"p\": ";
  append(text, pose.translation);
  text += ", \"q\": ";
  append(text, {q.w(), q.x(), q.y(), q.z()});
  text += '}';
}

/// One row of a grid, or any other stretch of it.
void append(std::string& text, std::span<const CellState> states) {
  constexpr std::string_view kSigns = "?.#v";  // by CellState
  static_assert(kSigns.size() == kCellStates);
  text += '"';
  for (std::size_t begin = 0, end = 0; begin < states.size(); begin = end) {
    while (end < states.size() && states[end] == states[begin]) ++end;
    if (end - begin > 1) append(text, end - begin);
    text += kSigns[static_cast<std::size_t>(states[begin])];
  }
  text += '"';
}

}  // namespace

void append_json_line(const ObstacleGrid& grid, std::string& text) {
  text += "{\"stamp_ns\": ";
  append(text, grid.stamp_ns);
  text += ", \"pose\": ";
  append(text, grid.pose);
  text += ", \"origin\": ";
  append(text, {grid.origin.x(), grid.origin.y()});
  text += ", \"cell_size\": ";
  append(text, grid.cell_size);
  text += ", \"columns\": ";
  append(text, grid.columns);
  text += ", \"rows\": ";
  append(text, grid.rows);
  text += ", \"states\": [";
  for (std::size_t row = 0; row < grid.rows; ++row) {
    if (row > 0) text += ", ";
    append(text, std::span(grid.state.data() + row * grid.columns, grid.columns));
  }
  text += "], \"ground\": [";
  std::string_view separator;
  for (const std::int16_t height : grid.ground) {
    if (height == ObstacleGrid::kNoGround) continue;
    text += separator;
    append(text, height);
    separator = ", ";
  }
  text += "]}\n";
}

void append_json_line(const ObstacleList& list, std::string& text) {
  text += "{\"stamp_ns\": ";
  append(text, list.stamp_ns);
  text += ", \"pose\": ";
  append(text, list.pose);
  text += ", \"obstacles\": [";
  std::string_view separator;
  for (const Obstacle& obstacle : list.obstacles) {
    text += separator;
    append(text, obstacle);
    separator = ", ";
  }
  text += "]}\n";
}

}  // namespace scree
