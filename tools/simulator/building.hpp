#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "scree/core/random.hpp"
#include "simulator/curves.hpp"
#include "simulator/placement.hpp"

namespace scree {

/// @param half of its length and width  @param yaw of its length, radians
Footprint rectangle(const Eigen::Vector2d& center, const Eigen::Vector2d& half, double yaw);

/// Draws the structures of one kind, one at a time.
class Building {
public:
  using Draw = TerrainThing (Building::*)();

  Building(const Terrain& terrain, FreeGround& ground, Random random)
      : terrain_(terrain), ground_(ground), random_(random) {}

  void build(int count, Draw draw, std::vector<TerrainThing>& things) {
    constexpr double kGap = 0.4;
    for (int i = 0; i < count; ++i) {
      constexpr int kTries = 30;
      for (int j = 0; j < kTries; ++j) {
        TerrainThing thing = (this->*draw)();
        if (!ground_.has_room(thing.feature.footprint, kGap)) continue;
        ground_.take(thing.feature.footprint);
        things.push_back(std::move(thing));
        break;
      }
    }
  }

  TerrainThing facade();
  TerrainThing fence();
  TerrainThing car();
  TerrainThing pole();
  /// A boom or log on two supports or one, or a table.
  TerrainThing boom();
  /// A small box, or a plank.
  TerrainThing debris();

private:
  static constexpr double kSunk = 0.3;  // metres that a wall or post goes into the ground
  static constexpr double kPart = 1;    // length of the parts of a long one, metres

  /// A straight structure from its middle to both sides.
  struct Line {
    Eigen::Vector2d middle;
    double yaw, length;
    Eigen::Vector2d at(double along) const { return middle + along * unit_vector(yaw); }
    /// Across it, to its left.
    Eigen::Vector2d aside(double off) const { return off * unit_vector(yaw + kTurn / 4); }
    /// The part that a place along it belongs to, from 1.
    std::uint16_t part(double along) const {
      const double parts = std::max(std::floor(length / kPart), 1.0);
      const double index = std::clamp((along + length / 2) / length * parts, 0.0, parts - 1);
      return static_cast<std::uint16_t>(index + 1);
    }
  };

  double ground_at(const Eigen::Vector2d& at) const { return terrain_.height(at.x(), at.y()); }
  Eigen::Vector3d above(const Eigen::Vector2d& at, double up) const {
    return {at.x(), at.y(), ground_at(at) + up};
  }
  Eigen::Vector2d near_way() {
    return ground_.near_way(terrain_.settings().placed_within, random_);
  }
  Line line_beside_way(double shortest, double longest);
  Line line_beyond_way(double shortest, double longest);
  void add(TerrainThing& thing, Volume volume, std::uint16_t part, double brightness);
  void add_wall(TerrainThing& thing, const Line& line, double from, double to, double recess,
                double height);
  void add_window(TerrainThing& thing, const Line& line, double along, double recess, double up);
  void finish(TerrainThing& thing, std::string_view name, const Eigen::Vector2d& at, double height,
              std::optional<Line> line = std::nullopt);

  const Terrain& terrain_;
  FreeGround& ground_;
  Random random_;
};

}  // namespace scree
