#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "scree/core/obstacle.hpp"

namespace scree {

/// What is wrong with a JSON file, and where: "obstacles[2].height: expected a number, found null".
struct JsonFault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws JsonFault that names line and column where the text is no JSON.
nlohmann::json parse_json(const std::string& text);
/// Whether a line is the blank one that some editors leave at the end of a file.
/// @param stream that it was read from
/// @param number of the line, from 1 on
bool is_blank_end(std::istream& stream, const std::string& line, int number);

/// A value of a JSON file and where it stands. Whatever is missing, of another type or out of range
/// throws JsonFault. Members that nobody asks for are allowed.
class JsonField {
public:
  /// Lengths beyond this are refused, so that no product of them overflows.
  static constexpr double kFarthest = 1e8;

  explicit JsonField(const nlohmann::json& value, std::string where = "");

  JsonField operator[](const char* key) const;
  bool has(const char* key) const;
  std::vector<JsonField> items() const;
  /// @pre the array has `count` items, or the file is refused
  std::vector<JsonField> items(std::size_t count) const;

  std::int64_t integer() const;
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  double number(double low = -kFarthest, double high = kFarthest) const;
  std::string text() const;
  ObstacleKind kind() const;
  Eigen::Vector3d vector() const;
  /// [x, y, z] as "p" and [w, x, y, z] as "q", made a unit quaternion.
  Pose pose() const;

  [[noreturn]] void refuse(const std::string& why) const;

private:
  const nlohmann::json* value_;
  std::string where_;
};

}  // namespace scree
