#include "scree/motion/deskew.hpp"

#include <algorithm>

#include "scree/motion/range_scatter.hpp"

namespace scree {
namespace {

/// The lidar's transforms within a sweep. The lasers of a firing share their time, nearly; a
/// transform serves until the time changes.
class LidarTrajectory {
public:
  explicit LidarTrajectory(const SweepTrajectory& trajectory) : trajectory_(trajectory) {}

  /// @param time_ns relative to the sweep's end
  const SweepTrajectory::Transform& at(std::int32_t time_ns) {
    if (time_ns == time_ns_) return to_base_;
    time_ns_ = time_ns;
    to_base_ = trajectory_.at(-std::int64_t{time_ns});
    return to_base_;
  }

private:
  SweepTrajectory trajectory_;
  std::int32_t time_ns_ = 1;
  SweepTrajectory::Transform to_base_;
};

}  // namespace

void deskew(const Sweep& sweep, const LidarSettings& lidar, const SweepTrajectory& trajectory,
            OwnReturns& own, DeskewedSweep& out, const TakenTurn& taken) {
  const auto nearest = static_cast<float>(lidar.min_range * lidar.min_range);
  const auto farthest = static_cast<float>(lidar.max_range * lidar.max_range);
  out.clear();
  const bool goes_on = taken.turn == sweep.turn;
  const std::size_t points_before = goes_on ? taken.points : 0;
  const std::size_t empty_before = goes_on ? taken.empty : 0;
  out.begins_turn = points_before + empty_before == 0;
  LidarTrajectory lidar_trajectory(trajectory.of_sensor(lidar.mount()));
  RangeScatter scatter;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f in_lidar(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const float square = in_lidar.squaredNorm();
    if (!(square >= nearest && square <= farthest)) continue;  // nor what is not a number
    if (own.take(in_lidar)) continue;
    const SweepTrajectory::Transform& to_base = lidar_trajectory.at(sweep.time_ns[i]);
    const Eigen::Vector3f point = to_base.rotation * in_lidar + to_base.translation;
    if (!out.points.push_back(point.x(), point.y(), point.z(), sweep.points.reflectivity[i])) {
      ++out.dropped;
      continue;
    }
    out.origins.push_back(to_base.translation);
    out.time_ns.push_back(sweep.time_ns[i]);
    out.is_suspect.push_back(own.is_suspect() ? 1 : 0);
    scatter.add(sweep.laser[i], in_lidar, out.scatter, out.is_isolated);
    if (i < points_before) out.fresh_points = out.points.size();
  }
  for (const EmptyShot& shot : sweep.empty) {
    const SweepTrajectory::Transform& to_base = lidar_trajectory.at(shot.time_ns);
    out.empty.push_back({to_base.translation, to_base.rotation * shot.end + to_base.translation});
  }
  out.fresh_empty = std::min(empty_before, out.empty.size());
}

}  // namespace scree
