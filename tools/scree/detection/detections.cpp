#include "detection/detections.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "common/progress.hpp"
#include "scoring/json_field.hpp"
#include "scree/capture/lcm_log.hpp"
#include "scree/detect/enclosing_polygon.hpp"
#include "scree/publish/message_decoder.hpp"
#include "scree/publish/messages.hpp"

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

std::vector<ObstacleList> lists_of_log(const std::filesystem::path& file) {
  LcmLogReader log = value_or_fail(LcmLogReader::open(file));
  std::vector<ObstacleList> lists;
  MessageDecoder decoder(
      [&](const obstacle_list_t& message) { from_message(message, lists.emplace_back()); },
      [](const health_t&) {});
  Progress progress("reading " + file.string(), std::filesystem::file_size(file));
  for (LcmEvent event; log.next(event); progress(log.position())) {
    decoder.take(event.channel, event.message);
  }
  if (lists.empty()) throw Failure(file.string() + ": the log has no list on SCREE_OBSTACLES");
  return lists;
}

/// A file or a pipe.
std::ifstream lists_stream(const std::filesystem::path& file) {
  std::error_code none;
  const auto status = std::filesystem::status(file, none);
  if (!std::filesystem::is_regular_file(status) && !std::filesystem::is_fifo(status)) {
    throw Failure("cannot read " + file.string() + ": it is neither a file nor a pipe");
  }
  std::ifstream stream(file);
  if (!stream) throw Failure("cannot read " + file.string());
  return stream;
}

/// As std::getline(), but for a limit: who writes a pipe may never end a line.
bool read_line(std::ifstream& stream, std::string& line) {
  constexpr std::size_t kLongest = std::size_t{256} << 20;
  line.clear();
  std::array<char, 1 << 16> part{};
  while (stream.getline(part.data(), part.size()), stream.gcount() > 0) {
    const bool has_end = stream.good();  // the line's end is counted
    line.append(part.data(), static_cast<std::size_t>(stream.gcount()) - (has_end ? 1 : 0));
    if (has_end || stream.eof()) return true;
    if (line.size() > kLongest) throw Failure("a line of the lists is longer than 256 MB");
    stream.clear();
  }
  return false;
}

}  // namespace

std::vector<ObstacleList> read_detections(const std::filesystem::path& file) {
  if (is_lcm_log(file)) return lists_of_log(file);
  std::ifstream stream = lists_stream(file);
  std::vector<ObstacleList> lists;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);  // of no pipe
  Progress progress("reading " + file.string(), unknown ? 0 : size);
  std::size_t position = 0;
  std::string line;
  for (int number = 1; read_line(stream, line); ++number) {
    progress(position += line.size() + 1);
    if (is_blank_end(stream, line, number)) break;
    try {
      const auto json = parse_json(line);
      if (JsonField(json).has("health")) continue;
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
