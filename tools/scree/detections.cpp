#include "detections.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"

namespace scree::cli {
namespace {

using Json = nlohmann::json;

Eigen::Vector3d vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Obstacle obstacle_of(const Json& json) {
  Obstacle obstacle;
  obstacle.id = json.at("id").get<std::int64_t>();
  const auto kind = json.at("kind").get<std::string>();
  obstacle.kind = kind == "negative" ? ObstacleKind::negative : ObstacleKind::positive;
  if (kind != name(obstacle.kind)) throw std::runtime_error("unknown kind \"" + kind + "\"");
  obstacle.confidence = json.at("confidence").get<float>();
  obstacle.center = vector_of(json.at("center"));
  obstacle.extent = vector_of(json.at("extent"));
  obstacle.yaw = json.at("yaw").get<double>();
  obstacle.height = json.at("height").get<double>();
  obstacle.points = json.at("points").get<std::uint32_t>();
  return obstacle;
}

ObstacleList list_of(const Json& json) {
  const Json& obstacles = json.at("obstacles");
  ObstacleList list(obstacles.size());
  list.stamp_ns = json.at("stamp_ns").get<std::int64_t>();
  list.pose.translation = vector_of(json.at("pose").at("p"));
  const Json& q = json.at("pose").at("q");
  list.pose.rotation = {q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(),
                        q.at(3).get<double>()};
  for (const Json& obstacle : obstacles) list.obstacles.push_back(obstacle_of(obstacle));
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
      lists.push_back(list_of(Json::parse(line)));
    } catch (const std::exception& error) {
      throw Failure(file.string() + ":" + std::to_string(number) +
                    ": not an obstacle list: " + error.what());
    }
  }
  return lists;
}

}  // namespace scree::cli
