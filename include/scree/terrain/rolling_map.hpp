#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/beam_count.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/occupancy.hpp"
#include "scree/core/point_cloud.hpp"
#include "scree/core/pose.hpp"
#include "scree/motion/deskew.hpp"
#include "scree/terrain/free_space.hpp"
#include "scree/terrain/toroidal_grid.hpp"

namespace scree {

/// The ground around the robot, put together of its sweeps: voxels in a frame of its own, around
/// the robot, bounded in number, reach and age. A voxel keeps the mean of its points. Points that
/// no second sweep confirms stay out of the cloud, and so does what hangs where nearly all beams
/// go through; what beams pass through again and again is forgotten.
class RollingMap {
public:
  RollingMap(const MapSettings& settings, std::size_t max_voxels);

  /// Adds a sweep that ended at `end_ns`, seen from `pose` (`base` in the map's frame), and
  /// forgets.
  /// @param reach metres from `base`; what lies farther off is not taken
  void add(const DeskewedSweep& sweep, const Pose& pose, std::int64_t end_ns,
           double reach = std::numeric_limits<double>::infinity());
  /// Everything is unseen again.
  void clear();

  /// The confirmed points within map.search_reach of the robot, in the map's frame shifted by
  /// -origin().
  const PointCloud& cloud() const { return cloud_; }
  /// Of each of these points: the beams that came to its voxel.
  std::span<const BeamCount> beams() const { return beams_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  /// Of a place in the map's frame, to the accuracy of the coarse cells in which free space is
  /// kept.
  Occupancy occupancy_at(const Eigen::Vector3d& point) const;

  std::size_t voxels() const { return voxels_.size(); }
  std::uint64_t dropped() const { return dropped_; }

private:
  struct Key {
    std::int16_t x = 0, y = 0, z = 0;
    bool operator==(const Key&) const = default;
    Key beside(int dx, int dy, int dz) const {
      return {static_cast<std::int16_t>(x + dx), static_cast<std::int16_t>(y + dy),
              static_cast<std::int16_t>(z + dz)};
    }
  };
  struct Voxel {
    Key key;
    std::uint16_t hits = 0;    ///< points, saturating
    std::uint16_t grains = 0;  ///< of them: that ended alone
    std::uint16_t sweeps = 0;  ///< that hit it, saturating
    std::uint16_t passed = 0;  ///< beams that went through it since the last hit
    BeamCount beams;
    std::uint32_t last_sweep = 0;
    std::int64_t seen_ns = 0;                        ///< end of that sweep
    std::uint32_t slot = 0;                          ///< in the index
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();  ///< the map's frame - origin
    float reflectivity = 0;
    bool is_confirmed = false;  ///< when confirm() looked last
    bool is_grain() const { return grains == hits; }
  };

  /// Cubes of 4 x 4 x 4 voxels; those far from one another share one.
  using BlockGrid = ToroidalGrid<128, 32>;

  Key key_of(const Eigen::Vector3f& point) const;
  /// Voxels in the block that holds a place.
  std::uint32_t& voxels_around(const Key& key) {
    return in_block_[BlockGrid::CellIndex{key.x >> 2, key.y >> 2, key.z >> 2}.slot()];
  }
  /// Where in the index a voxel stands, or the free place where it would.
  std::size_t slot_of(const Key& key) const;
  std::size_t first_slot(const Key& key) const;
  const Voxel* find(const Key& key) const;
  Voxel* find_or_add(const Key& key);
  void remove(std::size_t index);
  void recentre(const Pose& pose);
  void fade_beams();
  void forget(const Pose& pose);
  void see_through(const DeskewedSweep& sweep, const Eigen::Matrix3f& rotation,
                   const Eigen::Vector3f& translation, float reach);
  void follow(const Eigen::Vector3f& from, const Eigen::Vector3f& beam, float reach);
  bool confirm(Voxel& voxel) const;
  bool has_confirmation(const Voxel& voxel) const;
  bool is_dust(const Voxel& voxel) const;
  void gather_cloud(const Eigen::Vector3f& here);

  MapSettings settings_;
  float inverse_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  FixedVector<Voxel> voxels_;
  FixedVector<std::uint32_t> index_;  // open addressing; the index of a voxel plus one, 0 is free
  std::size_t mask_;
  FixedVector<std::uint32_t> in_block_;  // voxels; the air is empty, and beams pass it quickly
  FreeSpace free_space_;
  PointCloud cloud_;
  FixedVector<BeamCount> beams_;
  std::uint32_t sweep_ = 0;
  std::int64_t end_ns_ = 0, faded_ns_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
