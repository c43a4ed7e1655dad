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
requires std::is_arithmetic_v<Number>
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

void append(std::string& text, std::string_view word) {
  text += '"';
  text += word;
  text += '"';
}

void append(std::string& text, const Pose& pose);

/// The next member of an object. The first one gives its opening brace as `separator`.
template <class Value>
void append_member(std::string& text, std::string_view key, const Value& value,
                   std::string_view separator = ", ") {
  text += separator;
  append(text, key);
  text += ": ";
  append(text, value);
}

void append_member(std::string& text, std::string_view key, std::initializer_list<double> numbers,
                   std::string_view separator = ", ") {
  append_member<std::initializer_list<double>>(text, key, numbers, separator);
}

void append(std::string& text, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  append_member(text, "p", pose.translation, "{");
  append_member(text, "q", {q.w(), q.x(), q.y(), q.z()});
  text += '}';
}

void append(std::string& text, const Obstacle& obstacle) {
  append_member(text, "id", obstacle.id, "{");
  append_member(text, "kind", name(obstacle.kind));
  append_member(text, "confidence", obstacle.confidence);
  append_member(text, "center", obstacle.center);
  append_member(text, "extent", obstacle.extent);
  append_member(text, "yaw", obstacle.yaw);
  append_member(text, "height", obstacle.height);
  append_member(text, "velocity", {obstacle.velocity.x(), obstacle.velocity.y()});
  append_member(text, "points", obstacle.points);
  if (obstacle.evidence != Evidence::none) append_member(text, "evidence", name(obstacle.evidence));
  if (obstacle.footprint.has_area()) append_member(text, "footprint", obstacle.footprint);
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

void append_stamp_and_pose(std::string& text, std::int64_t stamp_ns, const Pose& pose) {
  append_member(text, "stamp_ns", stamp_ns, "{");
  append_member(text, "pose", pose);
}

}  // namespace

void append_json_line(const ObstacleGrid& grid, std::string& text) {
  append_stamp_and_pose(text, grid.stamp_ns, grid.pose);
  append_member(text, "origin", {grid.origin.x(), grid.origin.y()});
  append_member(text, "cell_size", grid.cell_size);
  append_member(text, "columns", grid.columns);
  append_member(text, "rows", grid.rows);
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
  append_stamp_and_pose(text, list.stamp_ns, list.pose);
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
