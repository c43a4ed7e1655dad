#include "scree/motion/deskew.hpp"

#include "scree/motion/range_scatter.hpp"

namespace scree {
namespace {

/// Where the lidar was within a sweep. The lasers of a firing share their time, nearly; a place
/// serves until the time changes.
class LidarPlaces {
public:
  LidarPlaces(const Pose& mount, const MotionTrack& track)
      : rotation_(mount.rotation.toRotationMatrix().cast<float>()),
        translation_(mount.translation.cast<float>()),
        track_(track) {}

  /// @param time_ns relative to the sweep's end
  const MotionTrack::Place& at(std::int32_t time_ns) {
    if (time_ns == time_ns_) return place_;
    time_ns_ = time_ns;
    const MotionTrack::Place base = track_.at(-std::int64_t{time_ns});
    place_.rotation = base.rotation * rotation_;
    place_.translation = base.rotation * translation_ + base.translation;
    return place_;
  }

private:
  Eigen::Matrix3f rotation_;
  Eigen::Vector3f translation_;
  const MotionTrack& track_;
  std::int32_t time_ns_ = 1;
  MotionTrack::Place place_;
};

}  // namespace

void deskew(const Sweep& sweep, const LidarSettings& lidar, const MotionTrack& track,
            DeskewedSweep& out) {
  const auto nearest = static_cast<float>(lidar.min_range * lidar.min_range);
  const auto farthest = static_cast<float>(lidar.max_range * lidar.max_range);
  out.clear();
  LidarPlaces places(lidar.mount(), track);
  RangeScatter scatter;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f seen(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const float square = seen.squaredNorm();
    if (!(square >= nearest && square <= farthest)) continue;  // nor what is not a number
    const MotionTrack::Place& place = places.at(sweep.time_ns[i]);
    const Eigen::Vector3f point = place.rotation * seen + place.translation;
    if (!out.points.push_back(point.x(), point.y(), point.z(), sweep.points.reflectivity[i])) {
      ++out.dropped;
      continue;
    }
    out.origins.push_back(place.translation);
    scatter.add(sweep.laser[i], seen, out.scatter, out.is_isolated);
  }
  for (const EmptyShot& shot : sweep.empty) {
    const MotionTrack::Place& place = places.at(shot.time_ns);
    out.empty.push_back({place.translation, place.rotation * shot.end + place.translation});
  }
}

}  // namespace scree
