#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/beam_count.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/occupancy.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/pose.hpp"
#include "scree/core/seen_cloud.hpp"
#include "scree/motion/deskew.hpp"
#include "scree/terrain/free_space.hpp"
#include "scree/terrain/voxel_hash_map.hpp"

namespace scree {

/// The ground around the robot, put together of its sweeps: voxels in a frame of its own, around
/// the robot, bounded in number, reach and age. A voxel keeps the mean of its points. Points that
/// no second sweep confirms stay out of the cloud. So does what hangs where nearly all beams go
/// through: dust. A voxel that beams pass through again and again is removed.
class RollingMap {
public:
  /// Within so many sweeps, or twice as many, what is out of date or out of reach is removed.
  static constexpr std::uint32_t kPruneSweeps = 8;

  RollingMap(const MapSettings& settings, std::size_t max_voxels);

  /// Adds what is fresh of a sweep that ended at `end_ns`, seen from `pose` (`base` in the map's
  /// frame). What has moved away is removed at once.
  /// @param reach metres from `base`; what lies farther off is not taken
  void add(const DeskewedSweep& sweep, const Pose& pose, std::int64_t end_ns,
           double reach = std::numeric_limits<double>::infinity());
  /// Everything is unknown again.
  void clear();

  /// The confirmed points within map.search_reach of the robot, in the map's frame shifted by
  /// -origin().
  const PointCloud& cloud() const { return cloud_; }
  /// For each of these points, the beams that came to its voxel.
  std::span<const BeamCount> beams() const { return beams_; }
  /// The cloud with all that is known of its beams, in the cloud's frame.
  SeenCloud seen_cloud() const { return {cloud_, beams_, origins_, passing_}; }
  const Eigen::Vector3d& origin() const { return origin_; }
  float search_reach() const { return static_cast<float>(settings_.search_reach); }
  /// What is known of a point in the map's frame, to the accuracy of FreeSpace's coarse cells.
  Occupancy occupancy_at(const Eigen::Vector3d& point) const;
  /// Whether a beam of the last two sweeps went through the coarse cell of a point in the map's
  /// frame, and none ended there.
  bool is_seen_through(const Eigen::Vector3d& point) const;

  /// Removes what was seen in an obstacle's box when it has left: beams go through nearly
  /// everywhere in it. To be called after a sweep was added; the cloud has it until update_cloud().
  /// @param obstacle in the map's frame; a low one is never said to have left
  /// @param was_left whether something that moves came from there: then what is left of it is
  /// looked at voxel by voxel
  /// @return whether it has left
  bool remove_left(const Obstacle& obstacle, bool was_left = false);
  /// Removes what someone who walks has left behind in an obstacle's box: voxels that few sweeps
  /// hit, in an order that goes on over the ground. What was hit just now stays.
  /// @param obstacle as in remove_left()
  /// @return whether nothing of it stays
  bool remove_trail(const Obstacle& obstacle);
  /// Takes the cloud out of the map anew, after something was removed.
  void update_cloud();
  /// In the map's frame.
  const FreeSpace& free_space() const { return free_space_; }

  std::size_t voxels() const { return voxels_.size(); }
  /// Points that found no room.
  std::uint64_t dropped() const { return dropped_; }

private:
  /// After this many beams went through a voxel since its last hit, what was there has moved away.
  static constexpr std::uint8_t kMostMisses = 8;

  /// Places where something was, and beams end or go through.
  struct Places {
    int there = 0, gone = 0;

    void add(FreeSpace::Presence presence) {
      there += presence == FreeSpace::Presence::there ? 1 : 0;
      gone += presence == FreeSpace::Presence::gone ? 1 : 0;
    }
    bool are_empty() const {
      constexpr int kFewest = 4, kMostThere = 5;  // gone through, and how many for each one left
      return gone >= kFewest && kMostThere * there <= gone;
    }
  };

  /// Wraps around in 13 years.
  static std::uint32_t tenths(std::int64_t time_ns) {
    return static_cast<std::uint32_t>(time_ns / 100'000'000);
  }
  VoxelKey key_of(const Eigen::Vector3f& point) const;
  void recenter(const Pose& pose);
  void decay_beam_counts();
  void add_points(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                  const Eigen::Vector3f& translation, float reach);
  void add_hit(MapVoxel& voxel, const Eigen::Vector3f& point, const DeskewedSweep& sweep,
               std::size_t index);
  void trace_rays(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                  const Eigen::Vector3f& translation, float reach);
  void trace_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& beam, float reach);
  void add_passing_beams(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                         const Eigen::Vector3f& translation);
  void add_passing_beam(const Eigen::Vector3f& origin, const Eigen::Vector3f& beam);
  void remove_moved();
  void fit_reach();
  void prune();
  Places places_in(const Obstacle& obstacle) const;
  Places voxels_in(const Obstacle& obstacle) const;
  template <class Visit>
  void for_each_voxel_in(const Obstacle& obstacle, float least, const Visit& visit);
  bool confirm(MapVoxel& voxel) const;
  bool has_confirmation(const MapVoxel& voxel) const;
  bool is_dust(const MapVoxel& voxel);

  MapSettings settings_;
  float inverse_;  // voxels a metre
  float reach_;    // metres, as far as there is room
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3f robot_ = Eigen::Vector3f::Zero();  // from the origin, after the last sweep
  VoxelHashMap voxels_;
  FixedVector<VoxelKey> moved_;  // within add(): what beams have gone through often enough
  std::size_t prune_end_ = 0;    // of the voxels that this round has not looked at
  std::size_t prune_step_ = 0;   // voxels that it looks at in a sweep
  FreeSpace free_space_;
  PointCloud cloud_;
  FixedVector<PassingBeam> passing_;  // of the latest sweeps, in a ring
  std::size_t next_passing_ = 0;
  FixedVector<BeamCount> beams_;
  FixedVector<Eigen::Vector3f> origins_;  // of the beam that hit each last
  std::uint32_t sweep_ = 0;               // number of the last sweep, from 1 on
  std::uint32_t looks_ = 0;               // at all voxels, for the cloud
  std::int64_t end_ns_ = 0, decayed_ns_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
