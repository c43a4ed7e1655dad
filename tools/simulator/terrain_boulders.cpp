#include <algorithm>
#include <cmath>
#include <numeric>

#include "simulator/boulders.hpp"
#include "simulator/noise.hpp"
#include "simulator/placement.hpp"
#include "simulator/terrain.hpp"

namespace scree {
namespace {

constexpr std::uint64_t kBoulders = 900;
constexpr double kLeastRock = 0.3;     // metres high: asked for
constexpr double kLeastStone = 0.12;   // metres high: neither asked for nor wrong
constexpr double kNamedWithin = 14;    // metres of a robot's way: nobody asks farther away
constexpr double kLeastVisible = 0.5;  // share of its outline that others do not cover

/// Lengths of a field's boulders, the longest first: together they cover the wanted share.
std::vector<double> draw_lengths(double cover, double size, Random& random) {
  constexpr double kShortest = 0.15;
  constexpr double kOverlap = 0.6;  // of the area of a square as long as the boulder
  const double longest = random.uniform(1.0, 2.2);
  const double power = random.uniform(1.6, 2.6);
  std::vector<double> lengths;
  for (double area = -std::log(1 - cover) * size * size; area > 0;) {
    lengths.push_back(draw_boulder_length(kShortest, longest, power, random));
    area -= kOverlap * lengths.back() * lengths.back();
  }
  std::ranges::sort(lengths, std::greater());
  return lengths;
}

}  // namespace

void Terrain::strew_boulders(std::uint64_t seed) {
  if (settings_.boulder_cover <= 0) return;
  Random random(seed, kBoulders);
  const GradientNoise coarse(Random(seed, kBoulders + 1), settings_.size, 0.5);
  const GradientNoise fine(Random(seed, kBoulders + 2), settings_.size, 0.15);
  const auto unevenness = [&](const Eigen::Vector2d& at) {
    return 0.8 * coarse(at.x(), at.y()) + 0.6 * fine(at.x(), at.y());
  };
  const FreeGround ground(*this);
  const std::size_t others = features_.size();
  std::vector<Boulder> named;
  for (const double length : draw_lengths(settings_.boulder_cover, settings_.size, random)) {
    const Boulder boulder = Boulder::draw(ground.anywhere(random), length, random);
    const Eigen::Vector2d& at = boulder.center();
    const double way = ground.from_way(at);
    const bool may_be_driven_over = boulder.height() < kLeastStone / 2;
    if (way < settings_.corridor_half_width + boulder.reach() && !may_be_driven_over) continue;
    // Those on top of a larger one roll off it most of the time.
    if (relief(at.x(), at.y()) > boulder.height() / 2 && !random.chance(0.1)) continue;
    if (boulder.height() > kLeastStone && !ground.has_room(boulder.footprint(), 0.1)) continue;
    std::uint16_t part = 0;
    const bool is_named = settings_.corridor.empty() || way < kNamedWithin;
    if (boulder.height() > kLeastStone && is_named) {
      TerrainFeature feature;
      feature.id = static_cast<int>(features_.size()) + 1;
      feature.name = "boulder";
      feature.kind = ObstacleKind::positive;
      feature.footprint = boulder.footprint();
      add_parts(feature, {&at, 1});
      part = static_cast<std::uint16_t>(feature.first_part);
      features_.push_back(std::move(feature));
      named.push_back(boulder);
    }
    heap(boulder, part, unevenness);
  }
  measure_boulders(others, named);
}

void Terrain::heap(const Boulder& boulder, std::uint16_t part, const Relief& unevenness) {
  for_each_vertex_near(boulder.center(), boulder.reach(),
                       [&](std::size_t index, const Eigen::Vector2d& at) {
                         const auto top = static_cast<float>(boulder.top(at, unevenness(at)));
                         if (top <= std::max(relief_[index], 0.0F)) return;
                         height_[index] += top - relief_[index];
                         relief_[index] = top;
                         part_[index] = part;
                       });
}

void Terrain::measure_boulders(std::size_t first, std::span<const Boulder> boulders) {
  for (std::size_t i = 0; i < boulders.size(); ++i) {
    TerrainFeature& feature = features_[first + i];
    const Boulder& boulder = boulders[i];
    double visible = 0;
    for_each_vertex_near(
        boulder.center(), boulder.reach(), [&](std::size_t index, const Eigen::Vector2d&) {
          if (part_[index] != feature.first_part) return;
          visible += settings_.cell * settings_.cell;
          feature.height = std::max(feature.height, static_cast<double>(relief_[index]));
        });
    feature.is_small = feature.height < kLeastRock || visible < kLeastVisible * boulder.area();
    const Eigen::Vector2d& at = boulder.center();
    feature.center = {at.x(), at.y(),
                      height(at.x(), at.y()) - relief(at.x(), at.y()) + feature.height / 2};
  }
}

}  // namespace scree
