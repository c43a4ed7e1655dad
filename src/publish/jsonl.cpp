#include "scree/publish/jsonl.hpp"

#include <charconv>
#include <cmath>
#include <initializer_list>
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

}  // namespace

void append_json_line(const ObstacleList& list, std::string& text) {
  const Eigen::Quaterniond& q = list.pose.rotation;
  text += "{\"stamp_ns\": ";
  append(text, list.stamp_ns);
  text += ", \"pose\": {\"p\": ";
  append(text, list.pose.translation);
  text += ", \"q\": ";
  append(text, {q.w(), q.x(), q.y(), q.z()});
  text += "}, \"obstacles\": [";
  std::string_view separator;
  for (const Obstacle& obstacle : list.obstacles) {
    text += separator;
    append(text, obstacle);
    separator = ", ";
  }
  text += "]}\n";
}

}  // namespace scree
