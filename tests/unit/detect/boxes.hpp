#pragma once

#include <cstdint>

#include "scree/core/obstacle.hpp"

namespace scree {

/// An obstacle 0.4 m high or deep with an id of its own.
inline Obstacle box(double x, double y, double length, double width, std::uint32_t points,
                    ObstacleKind kind = ObstacleKind::positive) {
  static std::int64_t next_id = 1;
  Obstacle obstacle;
  obstacle.id = next_id++;
  obstacle.kind = kind;
  obstacle.center = {x, y, 0.2};
  obstacle.extent = {length, width, 0.4};
  obstacle.height = kind == ObstacleKind::positive ? 0.4 : -0.4;
  obstacle.confidence = 0.9F;
  obstacle.points = points;
  return obstacle;
}

}  // namespace scree
