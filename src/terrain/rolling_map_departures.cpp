#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "scree/terrain/rolling_map.hpp"

// What is still in the map and has left.
namespace scree {
namespace {

constexpr float kKnee = 0.25F, kFloor = 0.05F;  // metres above an obstacle's lowest point

/// A box in the frame of the map's floats.
struct UprightBox {
  static constexpr float kMargin = 0.2F;  ///< metres

  Eigen::Vector2f middle, half;
  Eigen::Matrix2f turn;  // into the box
  float floor;

  UprightBox(const Obstacle& obstacle, const Eigen::Vector3d& origin)
      : middle((obstacle.center - origin).head<2>().cast<float>()),
        half(obstacle.extent.head<2>().cast<float>() / 2),
        turn(Eigen::Rotation2Df(static_cast<float>(-obstacle.yaw)).toRotationMatrix()),
        floor(static_cast<float>(obstacle.center.z() - obstacle.extent.z() / 2 - origin.z())) {}

  /// Whether a point higher than `least` above its floor lies in it, or beside it within reach.
  bool holds(const Eigen::Vector3f& point, float least) const {
    if (point.z() <= floor + least) return false;
    const Eigen::Vector2f at = turn * (point.head<2>() - middle);
    return std::abs(at.x()) < half.x() + kMargin && std::abs(at.y()) < half.y() + kMargin;
  }
};

/// A fit of the times at which voxels were last hit, as a plane over the ground.
class TimesOverGround {
public:
  /// @param at metres
  /// @param seconds from any instant, the same for all
  void add(const Eigen::Vector2f& at, float seconds) {
    const Eigen::Vector4d row(1, at.x(), at.y(), seconds);
    sums_ += row * row.transpose();
    earliest_ = std::min(earliest_, seconds);
    latest_ = std::max(latest_, seconds);
  }
  /// Whether they are what something leaves that goes straight on: the later, the farther.
  bool are_of_a_walk() const {
    constexpr double kLeast = 16, kLeastSeconds = 0.35;
    constexpr double kSlowest = 0.25, kFastest = 6;  // m/s
    constexpr double kExplained = 0.85;              // of the variance of the times
    if (sums_(0, 0) < kLeast || latest_ - earliest_ < kLeastSeconds) return false;
    const Eigen::Vector3d mean = sums_.block<3, 1>(1, 0) / sums_(0, 0);
    const Eigen::Matrix3d variance =
        sums_.block<3, 3>(1, 1) / sums_(0, 0) - mean * mean.transpose();
    const Eigen::Matrix2d spread =
        variance.topLeftCorner<2, 2>() + 1e-6 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d with_time = variance.block<2, 1>(0, 2);
    const Eigen::Vector2d slowness = spread.ldlt().solve(with_time);  // seconds a metre
    const double speed = 1 / std::max(slowness.norm(), 1e-6);
    return slowness.dot(with_time) >= kExplained * variance(2, 2) && speed >= kSlowest &&
           speed <= kFastest;
  }

private:
  Eigen::Matrix4d sums_ = Eigen::Matrix4d::Zero();
  float earliest_ = std::numeric_limits<float>::infinity();
  float latest_ = -std::numeric_limits<float>::infinity();
};

}  // namespace

/// Counts the places of a box, from knee height up to shortly below its top, by what beams tell.
RollingMap::Places RollingMap::places_in(const Obstacle& obstacle) const {
  constexpr double kStep = FreeSpace::kCell, kTop = 0.15;  // metres
  const Eigen::Rotation2Dd turn(obstacle.yaw);
  const Eigen::Vector3d half = obstacle.extent / 2;
  Places places;
  for (double z = kKnee - half.z(); z <= half.z() - kTop; z += kStep) {
    for (double along = -half.x(); along <= half.x(); along += kStep) {
      for (double across = -half.y(); across <= half.y(); across += kStep) {
        const Eigen::Vector2d at = turn * Eigen::Vector2d(along, across);
        const Eigen::Vector3d place = obstacle.center + Eigen::Vector3d(at.x(), at.y(), z);
        places.add(free_space_.presence(place.cast<float>(), sweep_));
      }
    }
  }
  return places;
}

/// The same for the voxels in a box: what is left of someone is narrow.
RollingMap::Places RollingMap::voxels_in(const Obstacle& obstacle) const {
  const UprightBox box(obstacle, origin_);
  const Eigen::Vector3f origin = origin_.cast<float>();
  Places places;
  for (const MapVoxel& voxel : voxels_) {
    if (!box.holds(voxel.mean, kKnee)) continue;
    places.add(free_space_.presence(voxel.mean + origin, sweep_));
  }
  return places;
}

bool RollingMap::remove_left(const Obstacle& obstacle, bool was_left) {
  constexpr double kUpright = 0.8;  // metres: beams pass above what is lower
  if (obstacle.height < kUpright) return false;
  const Places places = was_left ? voxels_in(obstacle) : places_in(obstacle);
  if (!places.are_empty()) return false;
  const UprightBox box(obstacle, origin_);
  for (std::size_t i = voxels_.size(); i-- > 0;) {
    if (box.holds(voxels_[i].mean, kFloor)) voxels_.erase(i, sweep_);
  }
  return true;
}

/// Calls visit(voxel) for those in a box that are higher than `least` above its floor, until it
/// returns false.
template <class Visit>
void RollingMap::for_each_voxel_in(const Obstacle& obstacle, float least, const Visit& visit) {
  const UprightBox box(obstacle, origin_);
  const Eigen::Vector3f middle = (obstacle.center - origin_).cast<float>();
  const float across = box.half.norm() + UprightBox::kMargin;
  const Eigen::Vector3f reach(across, across, static_cast<float>(obstacle.extent.z() / 2));
  const VoxelKey low = key_of(middle - reach), high = key_of(middle + reach);
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        MapVoxel* const voxel = voxels_.find(VoxelKey{}.shifted(x, y, z));
        if (voxel == nullptr || !box.holds(voxel->mean, least)) continue;
        if (!visit(*voxel)) return;
      }
    }
  }
}

/// Who walks far off is in each voxel for a moment only, and the lidar's rings leave gaps there
/// through which no beam tells that he has gone on.
bool RollingMap::remove_trail(const Obstacle& obstacle) {
  constexpr float kUpright = 0.4F;          // metres
  constexpr std::uint8_t kMostSweeps = 2;   // that hit a voxel which someone walked through
  constexpr int kSettled = 4, kShare = 20;  // voxels that more hit: so many, and one in so many
  constexpr std::uint32_t kFresh = 5;       // sweeps: he may be there still
  constexpr float kTenth = 0.1F;            // seconds
  constexpr double kLongest = 6;            // metres: a trail of some seconds
  if (obstacle.height < kUpright || obstacle.extent.head<2>().maxCoeff() > kLongest) return false;
  TimesOverGround times;
  int voxels = 0, settled = 0;
  const auto is_settled = [&] { return settled >= kSettled && kShare * settled > voxels; };
  for_each_voxel_in(obstacle, kKnee, [&](const MapVoxel& voxel) {
    ++voxels;
    settled += voxel.sweeps > kMostSweeps ? 1 : 0;
    const auto since_ds = static_cast<std::int32_t>(voxel.seen_ds - tenths(end_ns_));
    times.add(voxel.mean.head<2>(), kTenth * static_cast<float>(since_ds));
    return !is_settled();
  });
  if (is_settled() || !times.are_of_a_walk()) return false;
  bool is_left = true;
  for_each_voxel_in(obstacle, kFloor, [&](const MapVoxel& voxel) {
    if (sweep_ - voxel.last_sweep < kFresh) {
      is_left = false;
    } else if (voxel.sweeps <= kMostSweeps) {
      voxels_.erase(static_cast<std::size_t>(&voxel - voxels_.begin()), sweep_);
    }
    return true;
  });
  return is_left;
}

}  // namespace scree
