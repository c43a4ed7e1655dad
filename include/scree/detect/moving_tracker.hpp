#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <span>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/detect/tracker.hpp"

namespace scree {

/// Follows what moves from sweep to sweep, in a frame that stays: a Kalman filter with constant
/// velocity for each. One is published from the second sweep on that has it; through short
/// occlusions it goes on as it moved; it is gone soon after light goes through its place.
class MovingTracker {
public:
  struct Track {
    Obstacle obstacle;  ///< as seen last, at the filter's place; its id is 0 until it is published
    Eigen::Vector2d start = Eigen::Vector2d::Zero();     ///< where it was seen first
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< m/s
    // Covariance of place and velocity, the same along both axes: m^2, m^2/s, m^2/s^2.
    double place_variance = 0, covariance = 0, velocity_variance = 0;
    std::int64_t seen_ns = 0;
    std::uint32_t found = 0;  ///< sweeps that had it
    std::uint32_t gone = 0;   ///< sweeps since then whose beams went through its place
    bool is_matched = false;
  };

  explicit MovingTracker(std::size_t max_tracks);

  /// @param found in the map's frame
  /// @param is_seen_through whether beams of the last sweeps went through a place in that frame
  /// @param next_id the id of the next new obstacle; counts on
  void update(std::int64_t stamp_ns, std::span<const Obstacle> found,
              const std::function<bool(const Eigen::Vector3d&)>& is_seen_through,
              std::int64_t& next_id);
  /// Lets what is followed go on as it moved: nothing new is known of it.
  void predict(std::int64_t stamp_ns);
  void clear() { tracks_.clear(); }

  /// Adds the published ones to a list. An obstacle of the list in the same place goes. Where one
  /// that was followed has come to stand, and the list has it, it keeps its id there.
  /// @param list of what stands, in the map's frame
  /// @param standing that made the list
  void add_to(FixedVector<Obstacle>& list, const Eigen::Vector3d& robot, Tracker& standing);
  /// Whether something that moves came through the place of an obstacle of the map, and has left
  /// it.
  bool was_left(const Obstacle& standing) const;

  std::span<const Track> tracks() const { return {tracks_.data(), tracks_.size()}; }
  /// Things that no track had room for, and obstacles that did not fit into the list.
  std::uint64_t dropped() const { return dropped_; }

private:
  void associate(std::span<const Obstacle> found, std::int64_t stamp_ns);
  void hand_over(FixedVector<Obstacle>& list, Tracker& standing);
  static Obstacle published(const Track& track);
  static void add_found(const Obstacle& found, std::int64_t stamp_ns, Track& track);

  FixedVector<Track> tracks_;
  FixedVector<std::uint8_t> is_taken_;
  std::int64_t stamp_ns_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
