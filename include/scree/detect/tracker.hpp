#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/sight.hpp"

namespace scree {

/// Follows obstacles from list to list, in a frame that stays. An obstacle keeps its id; it appears
/// when its confidence, smoothed over lists, has grown enough and it was found more than once, and
/// goes when the confidence has fallen, at once where its place was seen empty.
class Tracker {
public:
  Tracker(const TrackingSettings& settings, std::size_t max_tracks);

  /// @param robot where it is, in the map's frame
  /// @param found every candidate of this list with its confidence, also low ones, in that frame
  /// @param sight of a place in it
  /// @param obstacles those to publish; their ids are the tracks'
  void update(std::int64_t stamp_ns, const Eigen::Vector3d& robot, std::span<const Obstacle> found,
              const std::function<Sight(const Eigen::Vector3d&)>& sight,
              FixedVector<Obstacle>& obstacles);
  void set(const TrackingSettings& settings) { settings_ = settings; }
  void clear() { tracks_.clear(); }

  /// Candidates that no track had room for, pairs of track and candidate beyond those compared, and
  /// obstacles that did not fit into a list.
  std::uint64_t dropped() const { return dropped_; }

private:
  struct Track {
    Obstacle obstacle;   // as found last
    float positive = 0;  // confidences, smoothed
    float negative = 0;
    std::uint32_t found = 0;
    std::int64_t found_ns = 0;
    bool is_published = false;
    bool is_matched = false;

    float confidence() const { return std::max(positive, negative); }
  };
  struct Pair {
    float distance;
    std::uint32_t track, found;
  };

  void match(std::span<const Obstacle> found);
  void learn(Track& track, const Obstacle* found, float share) const;

  TrackingSettings settings_;
  FixedVector<Track> tracks_;
  FixedVector<Pair> pairs_;
  FixedVector<std::int32_t> track_of_;  // of each found one, -1 for none
  FixedVector<Obstacle> published_;
  std::int64_t next_id_ = 1;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
