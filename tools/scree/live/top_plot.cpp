#include <algorithm>
#include <cmath>

#include "live/top_page.hpp"
#include "scree/core/rotation.hpp"

namespace scree::cli {
namespace {

constexpr double kAhead = 0.75;  // of the rows, before the robot

}  // namespace

std::vector<Sighting> sightings(const ObstacleList& list) {
  const Pose to_base = list.pose.inverse();
  std::vector<Sighting> all;
  for (const Obstacle& obstacle : list.obstacles) {
    const Eigen::Vector3d place = to_base * obstacle.center;
    all.push_back({&obstacle, place.x(), place.y(), std::hypot(place.x(), place.y())});
  }
  std::ranges::stable_sort(all, {}, &Sighting::distance);
  return all;
}

std::vector<std::string> plot(const std::vector<Sighting>& obstacles, double reach, int rows,
                              int columns) {
  if (rows < 1 || columns < 1) return {};
  std::vector<std::string> page(static_cast<std::size_t>(rows),
                                std::string(static_cast<std::size_t>(columns), ' '));
  const int robot_row = static_cast<int>(kAhead * (rows - 1)), robot_column = columns / 2;
  const double row = reach / std::max(robot_row, 1), column = row / 2;  // metres
  const auto mark = [&](double ahead, double left, char sign) {
    const double y = robot_row - ahead / row, x = robot_column - left / column;
    if (!(y > -0.5 && y < rows - 0.5 && x > -0.5 && x < columns - 0.5)) return;
    page[static_cast<std::size_t>(std::lround(y))][static_cast<std::size_t>(std::lround(x))] = sign;
  };
  constexpr int kFive = 5, kFar = 200;  // metres
  for (int ahead = -kFar; ahead <= kFar; ahead += kFive) {
    for (int left = -kFar; left <= kFar; left += kFive) mark(ahead, left, '.');
  }
  // The nearest last: it must not be covered.
  for (auto one = obstacles.rbegin(); one != obstacles.rend(); ++one) {
    mark(one->ahead, one->left, one->obstacle->kind == ObstacleKind::positive ? '#' : 'O');
  }
  mark(0, 0, '^');
  return page;
}

}  // namespace scree::cli
