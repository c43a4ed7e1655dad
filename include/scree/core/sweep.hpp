#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/point_cloud.hpp"

namespace scree {

/// Where shots without return are taken to end: farther than any sensor sees, metres.
inline constexpr float kNoReturnRange = 1000;

/// A shot that came back from nothing.
struct EmptyShot {
  Eigen::Vector3f end;       ///< kNoReturnRange along the beam, metres
  std::int32_t time_ns = 0;  ///< as of points; above zero after the last of them
};

/// One turn of the lidar, or what there is of it so far: its returns in firing order, in the
/// `lidar` frame.
struct Sweep {
  std::int64_t end_ns = 0;            ///< host time of the last point
  std::uint64_t turn = 0;             ///< counts the lidar's turns
  bool started_over = false;          ///< the lidar, since the sweep before
  bool ends_turn = true;              ///< else more of this turn will come, together with this
  PointCloud points;                  ///< `lidar` frame, metres
  FixedVector<std::int32_t> time_ns;  ///< of each point, relative to end_ns, zero or below
  FixedVector<std::uint8_t> laser;    ///< of each point: its number in the sensor, 0 to 15
  FixedVector<EmptyShot> empty;       ///< in firing order, `lidar` frame; what fits
  std::uint32_t packets = 0;          ///< data packets that gave it points
  std::uint32_t dropped = 0;          ///< points that did not fit
  bool is_whole = true;               ///< from its begin, unlike a lidar's first sweep, to its end
  bool is_standing = false;           ///< the lidar did not turn, it looked in one direction

  Sweep() = default;
  explicit Sweep(std::size_t capacity)
      : points(capacity), time_ns(capacity), laser(capacity), empty(capacity) {}

  /// @param at metres, `lidar` frame
  /// False when full; the point is then not taken.
  bool push_back(const Eigen::Vector3f& at, float reflectivity, std::int32_t t_ns,
                 std::size_t laser_number) {
    return points.push_back(at.x(), at.y(), at.z(), reflectivity) && time_ns.push_back(t_ns) &&
           laser.push_back(static_cast<std::uint8_t>(laser_number));
  }
  /// @pre its points and empty shots fit
  void copy_from(const Sweep& other) {
    points.copy_from(other.points);
    time_ns.copy_from(other.time_ns);
    laser.copy_from(other.laser);
    empty.copy_from(other.empty);
    end_ns = other.end_ns;
    turn = other.turn;
    packets = other.packets;
    dropped = other.dropped;
    started_over = other.started_over;
    ends_turn = other.ends_turn;
    is_whole = other.is_whole;
    is_standing = other.is_standing;
  }
  /// Moves all its times.
  void shift(std::int32_t by_ns) {
    for (std::int32_t& time : time_ns) time += by_ns;
    for (EmptyShot& shot : empty) shot.time_ns += by_ns;
  }
  void clear() {
    points.clear();
    time_ns.clear();
    laser.clear();
    empty.clear();
    end_ns = 0;
    packets = dropped = 0;
  }
};

}  // namespace scree
