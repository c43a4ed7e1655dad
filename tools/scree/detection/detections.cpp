#include "detection/detections.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "scoring/json_field.hpp"
#include "scree/detect/enclosing_polygon.hpp"

namespace scree::cli {
namespace {

Evidence evidence_of(const JsonField& field) {
  const auto at = std::ranges::find(kEvidenceNames, field.text());
  if (at == kEvidenceNames.end()) field.refuse("unknown evidence \"" + field.text() + "\"");
  return static_cast<Evidence>(at - kEvidenceNames.begin());
}

ConvexPolygon footprint_of(const JsonField& field) {
  std::vector<Eigen::Vector2d> corners;
  for (const JsonField& corner : field.items()) {
    const auto each = corner.items(2);
    corners.emplace_back(each[0].number(), each[1].number());
  }
  return enclosing_polygon(corners);
}

Obstacle obstacle_of(const JsonField& field) {
  Obstacle obstacle;
  obstacle.id = field["id"].integer();
  obstacle.kind = field["kind"].kind();
  obstacle.confidence = static_cast<float>(field["confidence"].number(0, 1));
  obstacle.center = field["center"].vector();
  obstacle.extent = field["extent"].vector();
  if (obstacle.extent.minCoeff() < 0) field["extent"].refuse("a box has no negative length");
  obstacle.yaw = field["yaw"].number();
  obstacle.height = field["height"].number();
  if (field.has("velocity")) {
    const auto velocity = field["velocity"].items(2);
    obstacle.velocity = {velocity[0].number(), velocity[1].number()};
  }
  obstacle.points = static_cast<std::uint32_t>(
      field["points"].integer(0, std::numeric_limits<std::uint32_t>::max()));
  if (field.has("evidence")) obstacle.evidence = evidence_of(field["evidence"]);
  if (field.has("footprint")) obstacle.footprint = footprint_of(field["footprint"]);
  return obstacle;
}

ObstacleList list_of(const JsonField& field) {
  const auto obstacles = field["obstacles"].items();
  ObstacleList list(obstacles.size());
  list.stamp_ns = field["stamp_ns"].integer();
  list.pose = field["pose"].pose();
  for (const JsonField& obstacle : obstacles) list.obstacles.push_back(obstacle_of(obstacle));
  return list;
}

}  // namespace

std::vector<ObstacleList> read_detections(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) throw Failure("cannot read " + file.string());
  std::vector<ObstacleList> lists;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    try {
      const auto json = parse_json(line);
      lists.push_back(list_of(JsonField(json)));
      if (lists.size() > 1 && lists.back().stamp_ns < lists[lists.size() - 2].stamp_ns) {
        JsonField(json)["stamp_ns"].refuse("it is before that of the line above");
      }
    } catch (const JsonFault& fault) {
      throw Failure(file.string() + ":" + std::to_string(number) +
                    ": not an obstacle list: " + fault.what());
    }
  }
  return lists;
}

}  // namespace scree::cli
