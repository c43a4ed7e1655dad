#include "scoring/json_field.hpp"

#include <spdlog/fmt/fmt.h>

#include <istream>
#include <limits>
#include <nlohmann/json.hpp>

namespace scree {

using Json = nlohmann::json;

Json parse_json(const std::string& text) {
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 5: ..."
    const std::string said = error.what();
    const std::size_t end = said.find("] ");
    throw JsonFault(end == std::string::npos ? said : said.substr(end + 2));
  }
}

bool is_blank_end(std::istream& stream, const std::string& line, int number) {
  return number > 1 && line.find_first_not_of(" \t\r") == std::string::npos &&
         stream.peek() == std::istream::traits_type::eof();
}

JsonField::JsonField(const Json& value, std::string where)
    : value_(&value), where_(std::move(where)) {}

void JsonField::refuse(const std::string& why) const {
  throw JsonFault(where_.empty() ? why : where_ + ": " + why);
}

JsonField JsonField::operator[](const char* key) const {
  if (!value_->is_object())
    refuse(fmt::format("expected an object, found {}", value_->type_name()));
  const auto found = value_->find(key);
  if (found == value_->end()) refuse(fmt::format("\"{}\" is missing", key));
  return JsonField(*found, where_.empty() ? key : where_ + "." + key);
}

bool JsonField::has(const char* key) const {
  return value_->is_object() && value_->contains(key);
}

std::vector<JsonField> JsonField::items() const {
  if (!value_->is_array()) refuse(fmt::format("expected an array, found {}", value_->type_name()));
  std::vector<JsonField> all;
  all.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    all.emplace_back((*value_)[i], fmt::format("{}[{}]", where_, i));
  }
  return all;
}

std::vector<JsonField> JsonField::items(std::size_t count) const {
  auto all = items();
  if (all.size() != count) refuse(fmt::format("expected {} items, found {}", count, all.size()));
  return all;
}

std::int64_t JsonField::integer() const {
  return integer(std::numeric_limits<std::int64_t>::min(),
                 std::numeric_limits<std::int64_t>::max());
}

std::int64_t JsonField::integer(std::int64_t low, std::int64_t high) const {
  if (!value_->is_number_integer()) {
    refuse(fmt::format("expected a whole number, found {}",
                       value_->is_number() ? value_->dump() : value_->type_name()));
  }
  const bool is_beyond =
      value_->is_number_unsigned() && value_->get<std::uint64_t>() > std::uint64_t{INT64_MAX};
  const auto number = value_->get<std::int64_t>();
  if (is_beyond || number < low || number > high) {
    refuse(fmt::format("{} is out of range", value_->dump()));
  }
  return number;
}

double JsonField::number(double low, double high) const {
  if (!value_->is_number()) refuse(fmt::format("expected a number, found {}", value_->type_name()));
  const auto number = value_->get<double>();
  if (!(number >= low && number <= high)) {
    refuse(fmt::format("{} is out of range ({:g} to {:g})", value_->dump(), low, high));
  }
  return number;
}

std::string JsonField::text() const {
  if (!value_->is_string()) refuse(fmt::format("expected a text, found {}", value_->type_name()));
  return value_->get<std::string>();
}

ObstacleKind JsonField::kind() const {
  const std::string word = text();
  for (const auto kind : {ObstacleKind::positive, ObstacleKind::negative}) {
    if (word == name(kind)) return kind;
  }
  refuse(fmt::format("unknown kind {}, expected \"positive\" or \"negative\"", value_->dump()));
}

Eigen::Vector3d JsonField::vector() const {
  const auto each = items(3);
  return {each[0].number(), each[1].number(), each[2].number()};
}

Pose JsonField::pose() const {
  Pose pose;
  pose.translation = (*this)["p"].vector();
  const JsonField q = (*this)["q"];
  const auto each = q.items(4);
  pose.rotation = {each[0].number(-2, 2), each[1].number(-2, 2), each[2].number(-2, 2),
                   each[3].number(-2, 2)};
  constexpr double kTolerance = 0.01;  // of numbers written with few digits
  if (std::abs(pose.rotation.norm() - 1) > kTolerance) {
    q.refuse(fmt::format("its length is {:.4f}, expected a unit quaternion", pose.rotation.norm()));
  }
  pose.rotation.normalize();
  return pose;
}

}  // namespace scree
