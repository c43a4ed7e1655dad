#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/core/fixed_vector.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/core/occupancy.hpp"
#include "scree/detect/fragment_merger.hpp"
#include "scree/detect/network.hpp"

namespace scree {

/// What the network that classifies tracks is told of one.
enum TrackFeature : std::size_t {
  track_positive,  ///< confidence that it is a rock, smoothed over lists
  track_negative,  ///< confidence that it is a hole, smoothed over lists
  track_best,      ///< most confidence of any list
  track_height,    ///< height above the surrounding ground, as found last, metres
  track_surer,     ///< distance to the nearest track with more confidence, at most 3, metres
  kTrackFeatures
};
static_assert(std::size_t{kTrackFeatures} <= Features().size(),
              "they are the first inputs of a network");

/// Follows obstacles from list to list, in a frame that stays. An obstacle keeps its id; it appears
/// when its confidence has grown enough and it was found more than once, and goes when the
/// confidence has fallen, soon where its place was seen empty. What wheels pass is followed only.
class Tracker {
public:
  struct Track {
    Obstacle obstacle;     ///< as found last
    Features features{};   ///< by TrackFeature
    float confidence = 0;  ///< that it is of its kind, as classified
    float found = 0;       ///< turns of the lidar whose lists had it
    float doubted = 0;     ///< turns whose lists gave too little confidence, the latest
    std::int64_t found_ns = 0;
    bool is_published = false;
    bool is_matched = false;     ///< found in the last list
    bool is_seen_empty = false;  ///< its place, in the last list

    /// Confidence by the detector's answers alone.
    float smoothed() const { return std::max(features[track_positive], features[track_negative]); }
  };

  /// @param network gives a track's confidence by its features; without it the smoothed confidence
  /// of the detector's answers counts
  Tracker(const TrackingSettings& settings, std::size_t max_tracks,
          std::optional<Network> network = std::nullopt);

  /// @param robot where it is, in the map's frame
  /// @param found every candidate of this list with its confidence, also low ones, in that frame
  /// @param occupancy_at what is known of a point in that frame
  /// @param obstacles those to publish; their ids are the tracks'
  /// @param turns of the lidar since the last list, 1 at most: what the settings say of lists is
  /// meant of turns
  void update(std::int64_t stamp_ns, const Eigen::Vector3d& robot, std::span<const Obstacle> found,
              const std::function<Occupancy(const Eigen::Vector3d&)>& occupancy_at,
              FixedVector<Obstacle>& obstacles, float turns = 1);
  void set(const TrackingSettings& settings) { settings_ = settings; }
  void clear() { tracks_.clear(); }
  /// Forgets the tracks whose obstacles have left.
  /// @return how many
  std::size_t remove_if(const std::function<bool(const Obstacle&)>& has_left);
  /// Gives an obstacle that is followed another id.
  void rename(std::int64_t id, std::int64_t new_id);
  /// No obstacle has got this id or a larger one yet.
  std::int64_t next_id() const { return next_id_; }
  void set_next_id(std::int64_t id) { next_id_ = id; }

  /// All that are followed, those not published too; valid until the next update().
  std::span<const Track> tracks() const { return {tracks_.data(), tracks_.size()}; }

  /// Candidates that no track had room for, pairs of track and candidate beyond those compared, and
  /// obstacles that did not fit into a list.
  std::uint64_t dropped() const { return dropped_; }

private:
  struct Pair {
    bool was_matched;  ///< the track, in the list before
    float distance;
    std::uint32_t track, found;
  };

  void associate(std::span<const Obstacle> found);
  void update_matched(std::int64_t stamp_ns, std::span<const Obstacle> found);
  void update_unmatched(const std::function<Occupancy(const Eigen::Vector3d&)>& occupancy_at);
  void remove_lost(std::int64_t stamp_ns);
  void start_tracks(std::int64_t stamp_ns, const Eigen::Vector3d& robot,
                    std::span<const Obstacle> found);
  void classify();
  void choose_published();
  void list_near(const Eigen::Vector3d& robot, FixedVector<Obstacle>& obstacles);

  float share_of(float of_a_turn) const;
  void add_found(std::int64_t stamp_ns, const Obstacle& found, Track& track) const;
  static void smooth(Features& features, float positive, float negative, float weight);
  float distance_to_surer(const Track& track) const;

  TrackingSettings settings_;
  std::optional<Network> network_;
  FixedVector<Track> tracks_;
  FixedVector<Pair> pairs_;
  FixedVector<std::int32_t> track_of_;  // index of the track of each found one, -1 for none
  FixedVector<Obstacle> published_;
  FragmentMerger fragment_merger_;
  FixedVector<std::int64_t> shown_, shown_before_;  // ids in the list
  float turns_ = 1;                                 // since the last list
  std::int64_t next_id_ = 1;
  std::uint64_t dropped_ = 0;
};

}  // namespace scree
