#include "scree/detect/grid_maker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

/// The cells of a row or column that a stretch of it touches, [begin, end).
struct CellSpan {
  std::size_t begin = 0, end = 0;
};

/// @param low, high the stretch, in cells; the span is empty where they are no numbers
CellSpan span_of(double low, double high, std::size_t cells) {
  const auto most = static_cast<double>(cells);
  if (!(low < most && high > 0)) return {};
  return {static_cast<std::size_t>(std::max(low, 0.0)),
          static_cast<std::size_t>(std::ceil(std::min(high, most)))};
}

/// Whether a square beside the polygon's sides lies beyond one of them.
/// @param half of the square's edge
bool is_apart(const ConvexPolygon& polygon, const Eigen::Vector2d& middle, double half) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Eigen::Vector2d outwards(side.y(), -side.x());
    if (outwards.dot(middle - polygon[i]) >= half * outwards.cwiseAbs().sum()) return true;
  }
  return false;
}

}  // namespace

const ObstacleGrid& GridMaker::make(const GroundSurface& surface, const Pose& surface_in_odom,
                                    const ObstacleList& list) {
  lay_out(list);
  look_at_ground(surface, surface_in_odom);
  cover(list, ObstacleKind::positive, CellState::occupied);
  cover(list, ObstacleKind::negative, CellState::drop);
  measure_ground(surface, surface_in_odom);
  return grid_;
}

void GridMaker::lay_out(const ObstacleList& list) {
  const double cell = settings_.cell_size;
  const auto half = std::clamp(static_cast<int>(std::ceil(settings_.reach / cell)), 1,
                               static_cast<int>(ObstacleGrid::kMostCells / 2));
  grid_.stamp_ns = list.stamp_ns;
  grid_.pose = list.pose;
  grid_.cell_size = cell;
  grid_.columns = grid_.rows = 2 * static_cast<std::size_t>(half);
  const Eigen::Vector2d robot = list.pose.translation.head<2>();
  grid_.origin = cell * ((robot / cell).array().round() - half).matrix();
  grid_.state.resize(grid_.cells());
  grid_.ground.resize(grid_.cells());
}

void GridMaker::look_at_ground(const GroundSurface& surface, const Pose& surface_in_odom) {
  // Places at the robot's height, from the plane of odom to the surface's.
  const Eigen::Isometry3d odom_in_surface = surface_in_odom.inverse().isometry();
  const Eigen::Matrix2d turn = odom_in_surface.linear().topLeftCorner<2, 2>();
  const Eigen::Vector2d shift =
      (odom_in_surface * Eigen::Vector3d(0, 0, grid_.pose.translation.z())).head<2>();
  for (std::size_t row = 0; row < grid_.rows; ++row) {
    for (std::size_t column = 0; column < grid_.columns; ++column) {
      grid_.state[row * grid_.columns + column] =
          state_of(surface, turn, turn * grid_.middle(column, row) + shift);
    }
  }
}

/// From places spread over the cell, no farther apart than the cells of the surface, so that each
/// of these that lies in it is asked.
/// @param turn of the grid in the surface's plane
/// @param middle of the cell, there
CellState GridMaker::state_of(const GroundSurface& surface, const Eigen::Matrix2d& turn,
                              const Eigen::Vector2d& middle) const {
  const auto surface_cell = static_cast<double>(surface.cell_size());
  // Ground seen somewhere in so wide a cell says too little of the parts of it.
  if (surface_cell > grid_.cell_size) return CellState::unknown;
  const auto places = static_cast<int>(std::ceil(grid_.cell_size / surface_cell));
  const Eigen::Matrix2f step = (turn * (grid_.cell_size / places)).cast<float>();
  const Eigen::Vector2f first =
      middle.cast<float>() -
      step * Eigen::Vector2f::Constant(0.5F * static_cast<float>(places - 1));
  int seen = 0;
  for (int v = 0; v < places; ++v) {
    for (int u = 0; u < places; ++u) {
      const Eigen::Vector2f place =
          first + static_cast<float>(u) * step.col(0) + static_cast<float>(v) * step.col(1);
      if (!surface.covers(place.x(), place.y())) continue;
      const std::size_t cell = surface.cell_at(place.x(), place.y());
      if (surface.points_in(cell) == 0) continue;
      if (stands_off(surface, cell)) return CellState::unknown;
      if (surface.is_ground(cell)) ++seen;
    }
  }
  return 2 * seen >= places * places ? CellState::free : CellState::unknown;
}

/// Whether something was seen in a cell of the surface that is no ground. @pre it has points
bool GridMaker::stands_off(const GroundSurface& surface, std::size_t cell) const {
  const float level = surface.level(cell);
  return surface.top(cell) - level >= settings_.body_height ||
         level - surface.seen(cell) >= settings_.body_height;
}

void GridMaker::cover(const ObstacleList& list, ObstacleKind kind, CellState state) {
  for (const Obstacle& obstacle : list.obstacles) {
    if (obstacle.kind == kind) cover(outline_of(obstacle), state);
  }
}

/// A cell is covered when a part of it is.
void GridMaker::cover(const ConvexPolygon& outline, CellState state) {
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Eigen::Vector2d& corner : outline) {
    const Eigen::Array2d place = (corner - grid_.origin) / grid_.cell_size;
    low = low.min(place);
    high = high.max(place);
  }
  const CellSpan columns = span_of(low.x(), high.x(), grid_.columns);
  const CellSpan rows = span_of(low.y(), high.y(), grid_.rows);
  for (std::size_t row = rows.begin; row < rows.end; ++row) {
    for (std::size_t column = columns.begin; column < columns.end; ++column) {
      if (is_apart(outline, grid_.middle(column, row), grid_.cell_size / 2)) continue;
      grid_.state[row * grid_.columns + column] = state;
    }
  }
}

void GridMaker::measure_ground(const GroundSurface& surface, const Pose& surface_in_odom) {
  constexpr double kMost = std::numeric_limits<std::int16_t>::max();
  const Eigen::Isometry3d to_odom = surface_in_odom.isometry(), odom_in_surface = to_odom.inverse();
  const double robot_z = grid_.pose.translation.z();
  for (std::size_t row = 0; row < grid_.rows; ++row) {
    for (std::size_t column = 0; column < grid_.columns; ++column) {
      const std::size_t cell = row * grid_.columns + column;
      grid_.ground[cell] = ObstacleGrid::kNoGround;
      if (grid_.state[cell] == CellState::unknown) continue;
      const Eigen::Vector2d middle = grid_.middle(column, row);
      Eigen::Vector3d place = odom_in_surface * Eigen::Vector3d(middle.x(), middle.y(), robot_z);
      place.z() = static_cast<double>(
          surface.height(static_cast<float>(place.x()), static_cast<float>(place.y())));
      const double above = 100 * ((to_odom * place).z() - robot_z);
      grid_.ground[cell] = static_cast<std::int16_t>(std::lround(std::clamp(above, -kMost, kMost)));
    }
  }
}

}  // namespace scree
