#include "scree/publish/messages.hpp"

#include <algorithm>
#include <vector>

namespace scree {
namespace {

static_assert(grid_t::UNKNOWN == static_cast<int>(CellState::unknown) &&
              grid_t::FREE == static_cast<int>(CellState::free) &&
              grid_t::OCCUPIED == static_cast<int>(CellState::occupied) &&
              grid_t::DROP == static_cast<int>(CellState::drop) &&
              grid_t::NO_GROUND == ObstacleGrid::kNoGround);

void to_array(const Eigen::Vector3d& vector, double (&array)[3]) {
  std::copy_n(vector.data(), 3, array);
}

void to_array(const Eigen::Quaterniond& rotation, double (&array)[4]) {
  array[0] = rotation.w();
  array[1] = rotation.x();
  array[2] = rotation.y();
  array[3] = rotation.z();
}

Eigen::Vector3d to_vector(const double (&array)[3]) {
  return {array[0], array[1], array[2]};
}

static_assert(obstacle_t::INSIDE == static_cast<int>(Evidence::inside) &&
              obstacle_t::WALL == static_cast<int>(Evidence::wall) &&
              obstacle_t::EDGE == static_cast<int>(Evidence::edge) &&
              obstacle_t::SHADOW == static_cast<int>(Evidence::shadow));

Evidence evidence_of(std::int8_t number) {
  const bool is_known = number >= 0 && static_cast<std::size_t>(number) < kEvidenceNames.size();
  return is_known ? static_cast<Evidence>(number) : Evidence::none;
}

/// Vectors of the message only grow, so that a shorter list frees nothing that a longer one needs.
template <class Item>
void grow(std::vector<Item>& items, std::size_t size) {
  if (items.size() < size) items.resize(size);
}

void to_message(const Obstacle& from, obstacle_t& to) {
  to.id = from.id;
  to.kind = from.kind == ObstacleKind::positive ? obstacle_t::POSITIVE : obstacle_t::NEGATIVE;
  to.confidence = from.confidence;
  to_array(from.center, to.center);
  to_array(from.extent, to.extent);
  to.yaw = from.yaw;
  to.height = from.height;
  std::copy_n(from.velocity.data(), 2, to.velocity);
  to.points = static_cast<std::int32_t>(from.points);
  to.evidence = static_cast<std::int8_t>(from.evidence);
  const std::size_t corners = from.footprint.has_area() ? from.footprint.size() : 0;
  to.corners = static_cast<std::int32_t>(corners);
  grow(to.footprint, corners);
  for (std::size_t i = 0; i < corners; ++i) {
    grow(to.footprint[i], 2);
    std::copy_n(from.footprint[i].data(), 2, to.footprint[i].data());
  }
}

Obstacle from_message(const obstacle_t& from) {
  Obstacle to;
  to.id = from.id;
  to.kind = from.kind > 0 ? ObstacleKind::positive : ObstacleKind::negative;
  to.confidence = from.confidence;
  to.center = to_vector(from.center);
  to.extent = to_vector(from.extent);
  to.yaw = from.yaw;
  to.height = from.height;
  to.velocity = {from.velocity[0], from.velocity[1]};
  to.points = static_cast<std::uint32_t>(from.points);
  to.evidence = evidence_of(from.evidence);
  for (std::size_t i = 0; i < static_cast<std::size_t>(from.corners); ++i) {
    to.footprint.push_back({from.footprint[i][0], from.footprint[i][1]});
  }
  return to;
}

}  // namespace

void make_room(std::size_t obstacles, obstacle_list_t& message) {
  obstacle_t obstacle{};
  obstacle.corners = ConvexPolygon::kMaxCorners;
  obstacle.footprint.assign(ConvexPolygon::kMaxCorners, std::vector<double>(2));
  message.size = static_cast<std::int32_t>(obstacles);
  message.obstacles.assign(obstacles, obstacle);
}

void to_message(const ObstacleList& list, obstacle_list_t& message) {
  message.stamp_ns = list.stamp_ns;
  to_array(list.pose.translation, message.p);
  to_array(list.pose.rotation, message.q);
  message.size = static_cast<std::int32_t>(list.obstacles.size());
  grow(message.obstacles, list.obstacles.size());
  for (std::size_t i = 0; i < list.obstacles.size(); ++i) {
    to_message(list.obstacles[i], message.obstacles[i]);
  }
}

void from_message(const obstacle_list_t& message, ObstacleList& list) {
  const auto size = static_cast<std::size_t>(message.size);
  list.stamp_ns = message.stamp_ns;
  list.pose.translation = to_vector(message.p);
  list.pose.rotation = {message.q[0], message.q[1], message.q[2], message.q[3]};
  if (list.obstacles.capacity() < size) list.obstacles = FixedVector<Obstacle>(size);
  list.obstacles.clear();
  for (std::size_t i = 0; i < size; ++i) {
    list.obstacles.push_back(from_message(message.obstacles[i]));
  }
}

void make_room(grid_t& message) {
  constexpr std::size_t kMost = ObstacleGrid::kMostCells;
  message.columns = message.rows = static_cast<std::int32_t>(kMost);
  message.cells = static_cast<std::int32_t>(kMost * kMost);
  message.state.resize(kMost * kMost);
  message.ground.resize(kMost * kMost);
}

void to_message(const ObstacleGrid& grid, grid_t& message) {
  message.stamp_ns = grid.stamp_ns;
  to_array(grid.pose.translation, message.p);
  to_array(grid.pose.rotation, message.q);
  std::copy_n(grid.origin.data(), 2, message.origin);
  message.cell_size = grid.cell_size;
  message.columns = static_cast<std::int32_t>(grid.columns);
  message.rows = static_cast<std::int32_t>(grid.rows);
  message.cells = static_cast<std::int32_t>(grid.cells());
  grow(message.state, grid.cells());
  grow(message.ground, grid.cells());
  std::ranges::transform(grid.state, message.state.begin(),
                         [](CellState state) { return static_cast<std::uint8_t>(state); });
  std::ranges::copy(grid.ground, message.ground.begin());
}

bool from_message(const grid_t& message, ObstacleGrid& grid) {
  constexpr auto kMost = static_cast<std::int32_t>(ObstacleGrid::kMostCells);
  grid.clear();
  const auto is_length = [](std::int32_t cells) { return cells >= 0 && cells <= kMost; };
  if (!is_length(message.columns) || !is_length(message.rows)) return false;
  if (message.columns * message.rows != message.cells) return false;
  grid.pose.translation = to_vector(message.p);
  grid.pose.rotation = {message.q[0], message.q[1], message.q[2], message.q[3]};
  grid.origin = {message.origin[0], message.origin[1]};
  const bool are_numbers = grid.pose.translation.allFinite() &&
                           grid.pose.rotation.coeffs().allFinite() && grid.origin.allFinite();
  if (!are_numbers || !(message.cell_size > 0) || !std::isfinite(message.cell_size)) return false;
  grid.stamp_ns = message.stamp_ns;
  grid.cell_size = message.cell_size;
  grid.columns = static_cast<std::size_t>(message.columns);
  grid.rows = static_cast<std::size_t>(message.rows);
  for (std::size_t i = 0; i < grid.cells(); ++i) {
    // A cell that nobody can place on the ground says nothing.
    const bool is_known =
        message.state[i] < kCellStates && message.ground[i] != ObstacleGrid::kNoGround;
    grid.state.push_back(is_known ? static_cast<CellState>(message.state[i]) : CellState::unknown);
    grid.ground.push_back(is_known && grid.state.back() != CellState::unknown
                              ? message.ground[i]
                              : ObstacleGrid::kNoGround);
  }
  return true;
}

}  // namespace scree
