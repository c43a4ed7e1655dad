#include "scree/motion/deskew.hpp"

#include "scree/motion/range_scatter.hpp"

namespace scree {

void deskew(const Sweep& sweep, const LidarSettings& lidar, const MotionTrack& track,
            DeskewedSweep& out) {
  const Pose mount = lidar.mount();
  const Eigen::Matrix3f rotation = mount.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = mount.translation.cast<float>();
  const auto nearest = static_cast<float>(lidar.min_range * lidar.min_range);
  const auto farthest = static_cast<float>(lidar.max_range * lidar.max_range);
  out.clear();
  RangeScatter scatter;
  // The lasers of a firing share their time, nearly; a place serves until the time changes.
  std::int32_t placed_ns = 1;
  MotionTrack::Place lidar_at;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f seen(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const float square = seen.squaredNorm();
    if (!(square >= nearest && square <= farthest)) continue;  // nor what is not a number
    if (sweep.time_ns[i] != placed_ns) {
      placed_ns = sweep.time_ns[i];
      const MotionTrack::Place base_at = track.at(-std::int64_t{placed_ns});
      lidar_at.rotation = base_at.rotation * rotation;
      lidar_at.translation = base_at.rotation * translation + base_at.translation;
    }
    const Eigen::Vector3f point = lidar_at.rotation * seen + lidar_at.translation;
    if (!out.points.push_back(point.x(), point.y(), point.z(), sweep.points.reflectivity[i])) {
      ++out.dropped;
      continue;
    }
    out.origins.push_back(lidar_at.translation);
    scatter.add(sweep.laser[i], seen, out.scatter, out.is_grain);
  }
}

}  // namespace scree
