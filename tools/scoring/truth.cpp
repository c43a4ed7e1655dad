#include "scoring/truth.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "scoring/json_field.hpp"
#include "scree/core/read_file.hpp"

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

int id_of(const JsonField& field) {
  return static_cast<int>(
      field.integer(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

/// A time, which must not fall from entry to entry.
std::int64_t time_of(const JsonField& field, std::int64_t& last_ns) {
  const std::int64_t t_ns = field.integer();
  if (t_ns < last_ns) field.refuse(fmt::format("{} is before the entry above it", t_ns));
  return last_ns = t_ns;
}

std::vector<TrueObstacle::Place> track_of(const JsonField& field) {
  std::vector<TrueObstacle::Place> track;
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (const JsonField& place : field.items()) {
    const auto each = place.items(4);
    track.push_back(
        {time_of(each[0], last_ns), {each[1].number(), each[2].number()}, each[3].number()});
  }
  if (track.empty()) field.refuse("it has no place");
  return track;
}

TrueObstacle obstacle_of(const JsonField& field) {
  TrueObstacle obstacle;
  obstacle.id = id_of(field["id"]);
  obstacle.kind = field["kind"].kind();
  obstacle.center = field["center"].vector();
  obstacle.height = field["height"].number();
  if (field.has("shape")) obstacle.shape = field["shape"].text();
  if (field.has("track")) obstacle.track = track_of(field["track"]);
  const JsonField footprint = field["footprint"];
  for (const JsonField& corner : footprint.items()) {
    const auto each = corner.items(2);
    obstacle.footprint.emplace_back(each[0].number(), each[1].number());
  }
  obstacle.footprint = uncrossed(std::move(obstacle.footprint));
  if (obstacle.footprint.empty()) footprint.refuse("it has no area");
  return obstacle;
}

Truth truth_of(const JsonField& file) {
  Truth truth;
  std::set<int> known;
  for (const JsonField& field : file["obstacles"].items()) {
    truth.obstacles.push_back(obstacle_of(field));
    const int id = truth.obstacles.back().id;
    if (!known.insert(id).second) field["id"].refuse(fmt::format("{} stands twice", id));
  }
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
  for (const JsonField& field : file["poses"].items()) {
    truth.poses.push_back({time_of(field["t_ns"], last_ns), field.pose()});
  }
  if (truth.poses.empty()) file["poses"].refuse("there is none");
  last_ns = std::numeric_limits<std::int64_t>::min();
  for (const JsonField& field : file["visible"].items()) {
    Truth::Sight sight{time_of(field["t_ns"], last_ns), {}, {}};
    std::set<int> named;
    const auto read_ids = [&](const JsonField& list, std::vector<int>& ids) {
      for (const JsonField& each : list.items()) {
        const int id = id_of(each);
        if (!known.contains(id)) each.refuse(fmt::format("no obstacle has the id {}", id));
        if (!named.insert(id).second) each.refuse(fmt::format("{} stands twice", id));
        ids.push_back(id);
      }
    };
    read_ids(field["ids"], sight.ids);
    read_ids(field["ignore"], sight.ignore);
    truth.visible.push_back(std::move(sight));
  }
  return truth;
}

double rounded(double metres) {
  const double value = std::round(metres * 1e4) / 1e4;
  return value == 0 ? 0 : value;  // no -0.0
}

Json to_json(const Eigen::Vector3d& p) {
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json to_json(const TrueObstacle& obstacle) {
  Json footprint = Json::array();
  for (const Eigen::Vector2d& corner : obstacle.footprint) {
    footprint.push_back({rounded(corner.x()), rounded(corner.y())});
  }
  Json json{{"id", obstacle.id},
            {"kind", name(obstacle.kind)},
            {"center", to_json(obstacle.center)},
            {"footprint", footprint},
            {"height", rounded(obstacle.height)}};
  if (!obstacle.shape.empty()) json["shape"] = obstacle.shape;
  for (const auto& [t_ns, position, yaw] : obstacle.track) {
    json["track"].push_back({t_ns, rounded(position.x()), rounded(position.y()), rounded(yaw)});
  }
  return json;
}

Json to_json(const Truth& truth) {
  Json json{{"obstacles", Json::array()}, {"poses", Json::array()}, {"visible", Json::array()}};
  for (const TrueObstacle& obstacle : truth.obstacles) {
    json["obstacles"].push_back(to_json(obstacle));
  }
  for (const auto& [t_ns, base] : truth.poses) {
    const Eigen::Quaterniond& q = base.rotation;
    json["poses"].push_back(
        {{"t_ns", t_ns}, {"p", to_json(base.translation)}, {"q", {q.w(), q.x(), q.y(), q.z()}}});
  }
  for (const auto& [t_ns, ids, ignore] : truth.visible) {
    json["visible"].push_back({{"t_ns", t_ns}, {"ids", ids}, {"ignore", ignore}});
  }
  return json;
}

/// The entries around a time, and how far it lies from the one to the other. Before the first and
/// after the last entry both are that one.
template <class Entry>
struct Between {
  const Entry &before, &after;
  double share = 0;

  /// @pre !entries.empty()
  Between(const std::vector<Entry>& entries, std::int64_t t_ns)
      : Between(t_ns, std::ranges::lower_bound(entries, t_ns, {}, &Entry::t_ns), entries) {}

private:
  template <class Iterator>
  Between(std::int64_t t_ns, Iterator at, const std::vector<Entry>& entries)
      : before(at == entries.begin() ? *at : *(at - 1)),
        after(at == entries.end() ? *(at - 1) : *at) {
    // In double before subtracting: times from outside may lie further apart than an int64 holds.
    const auto begin = static_cast<double>(before.t_ns);
    const double step = static_cast<double>(after.t_ns) - begin;
    if (step > 0) share = (static_cast<double>(t_ns) - begin) / step;
  }
};

}  // namespace

Pose Truth::pose_at(std::int64_t t_ns) const {
  const auto [before, after, share] = Between(poses, t_ns);
  return {before.base.translation + share * (after.base.translation - before.base.translation),
          before.base.rotation.slerp(share, after.base.rotation)};
}

TrueObstacle::Place place_at(const std::vector<TrueObstacle::Place>& track, std::int64_t t_ns) {
  const auto [before, after, share] = Between(track, t_ns);
  const double turn = std::remainder(after.yaw - before.yaw, 2 * std::numbers::pi);
  return {t_ns, before.position + share * (after.position - before.position),
          before.yaw + share * turn};
}

TrueObstacle TrueObstacle::at(std::int64_t t_ns) const {
  TrueObstacle there = *this;
  if (!moves()) return there;
  const Place first = track.front(), now = place_at(track, t_ns);
  const Eigen::Rotation2Dd turn(now.yaw - first.yaw);
  const auto moved = [&](const Eigen::Vector2d& point) -> Eigen::Vector2d {
    return now.position + turn * (point - first.position);
  };
  there.center.head<2>() = moved(center.head<2>());
  for (Eigen::Vector2d& corner : there.footprint) corner = moved(corner);
  return there;
}

Eigen::Vector2d TrueObstacle::velocity_at(std::int64_t t_ns) const {
  constexpr std::int64_t kAround = 100'000'000;
  if (!moves()) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d before = place_at(track, t_ns - kAround).position;
  return (place_at(track, t_ns + kAround).position - before) / (2e-9 * kAround);
}

Result<Truth> read_truth(const std::filesystem::path& file) {
  const auto text = read_file(file, std::numeric_limits<std::uintmax_t>::max());
  if (!text) return tl::make_unexpected(text.error());
  try {
    const auto json = parse_json(*text);
    return truth_of(JsonField(json));
  } catch (const JsonFault& fault) {
    return fail(fmt::format("{}: no truth: {}", file.string(), fault.what()));
  }
}

Result<void> write_truth(const std::filesystem::path& file, const Truth& truth) {
  std::ofstream stream(file, std::ios::binary);
  stream << to_json(truth).dump() << '\n' << std::flush;
  if (!stream) return fail(fmt::format("cannot write {}", file.string()));
  return {};
}

}  // namespace scree
