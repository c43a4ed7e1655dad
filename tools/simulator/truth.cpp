#include "simulator/truth.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double metres) {
  const double value = std::round(metres * 1e4) / 1e4;
  return value == 0 ? 0 : value;  // no -0.0
}

Json to_json(const Eigen::Vector3d& p) {
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json to_json(const TerrainFeature& feature) {
  Json footprint = Json::array();
  for (const Eigen::Vector2d& corner : feature.footprint) {
    footprint.push_back({rounded(corner.x()), rounded(corner.y())});
  }
  return {{"id", feature.id},
          {"kind", name(*feature.kind)},
          {"center", to_json(feature.center)},
          {"footprint", footprint},
          {"height", rounded(feature.height)},
          {"shape", name_of(feature.shape)}};
}

Json to_json(const Truth& truth, const Terrain& terrain) {
  Json json{{"obstacles", Json::array()}, {"poses", Json::array()}, {"visible", Json::array()}};
  for (const TerrainFeature& feature : terrain.features()) {
    if (feature.kind) json["obstacles"].push_back(to_json(feature));
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

}  // namespace

Result<void> write_truth(const std::filesystem::path& file, const Terrain& terrain,
                         const Truth& truth) {
  std::ofstream stream(file, std::ios::binary);
  stream << to_json(truth, terrain).dump() << '\n' << std::flush;
  if (!stream) return fail(fmt::format("cannot write {}", file.string()));
  return {};
}

}  // namespace scree
