#include "simulator/movers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace scree {

TrueObstacle true_obstacle(const Mover& mover, int id, const Terrain& terrain) {
  const TrueObstacle::Place& first = mover.track.front();
  TrueObstacle obstacle;
  obstacle.id = id;
  obstacle.shape = mover.name;
  obstacle.height = mover.height;
  obstacle.track = mover.track;
  const Eigen::Vector2d& at = first.position;
  obstacle.center = {at.x(), at.y(), terrain.height(at.x(), at.y()) + mover.height / 2};
  const Eigen::Rotation2Dd turn(first.yaw);
  for (const Eigen::Vector2d& corner : mover.footprint) {
    obstacle.footprint.emplace_back(at + turn * corner);
  }
  return obstacle;
}

PlacedMovers::PlacedMovers(std::span<const Mover> movers, const Terrain& terrain,
                           std::size_t first_part)
    : movers_(movers), terrain_(terrain) {
  for (const Mover& mover : movers) {
    Placed placed;
    placed.bodies = mover.bodies;
    placed.radius = Eigen::Vector2d(mover.radius, mover.height / 2).norm();
    for (Volume& body : placed.bodies) {
      body.part = static_cast<std::uint16_t>(first_part + placed_.size());
      body.is_turned = true;
    }
    placed_.push_back(std::move(placed));
  }
}

void PlacedMovers::move_to(std::int64_t t_ns) {
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    const TrueObstacle::Place place = place_at(mover.track, t_ns);
    const Eigen::Vector2d& at = place.position;
    const Eigen::Vector3d foot(at.x(), at.y(), terrain_.height(at.x(), at.y()));
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    placed_[i].middle = foot + Eigen::Vector3d(0, 0, mover.height / 2);
    for (std::size_t j = 0; j < mover.bodies.size(); ++j) {
      placed_[i].bodies[j].center = foot + turn * mover.bodies[j].center;
      placed_[i].bodies[j].axes = turn * mover.bodies[j].axes;
    }
  }
}

std::optional<VolumeHit> PlacedMovers::cast(const Eigen::Vector3d& origin,
                                            const Eigen::Vector3d& direction,
                                            double max_range) const {
  VolumeHit nearest{max_range, nullptr};
  for (const Placed& placed : placed_) {
    const Eigen::Vector3d to = placed.middle - origin;
    const double along = to.dot(direction);
    if (along < -placed.radius || along - placed.radius > nearest.range) continue;
    if (to.squaredNorm() - along * along > placed.radius * placed.radius) continue;
    for (const Volume& body : placed.bodies) {
      const auto range = body.range_to(origin, direction);
      if (range && *range < nearest.range) nearest = {*range, &body};
    }
  }
  if (nearest.volume == nullptr) return std::nullopt;
  return nearest;
}

}  // namespace scree
