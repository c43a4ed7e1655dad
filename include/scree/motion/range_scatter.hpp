#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"

namespace scree {

/// How much the ranges of neighbouring shots of a laser scatter. On a rock they follow one another
/// however steep it is; among blades of grass each shot goes as deep as it happens to (compare
/// Castano and Matthies, "Foliage discrimination using a rotating ladar", ICRA 2003). Shots that
/// meet grains of dust are isolated: their neighbours end elsewhere.
class RangeScatter {
public:
  static constexpr float kMaxScatter = 0.1F;  ///< metres; a shot without neighbours has it, too

  /// Takes the next point of a turn. The middle one of three neighbouring shots is off the straight
  /// line between the others; a point's scatter is the least of that over the threes it is in, so
  /// that an edge beside it does not count.
  /// @param point metres, `lidar` frame
  /// @param scatter of the points so far, metres; gets one more
  /// @param is_isolated of the points so far: 1 where none of the four shots before and after it,
  /// up to a degree off, ended within 0.3 m of its range, else 0; gets one more
  void add(std::uint8_t laser, const Eigen::Vector3f& point, FixedVector<float>& scatter,
           FixedVector<std::uint8_t>& is_isolated);

private:
  struct Shot {
    Eigen::Vector3f direction = Eigen::Vector3f::Zero();
    float range = 0, step = 0;  ///< metres; rad from the one before, 0 where that is no neighbour
    std::size_t index = 0;
  };
  static constexpr std::size_t kLasers = 16;
  /// The latest shots of a laser, in a ring.
  struct RecentShots {
    static constexpr std::size_t kShots = 4;
    std::array<Shot, kShots> shots;
    std::size_t count = 0;
    const Shot& back(std::size_t shots_ago) const { return shots[(count - shots_ago) % kShots]; }
  };
  static void mark_neighbours(const RecentShots& recent, const Shot& shot,
                              FixedVector<std::uint8_t>& is_isolated);

  std::array<RecentShots, kLasers> lasers_{};
};

}  // namespace scree
