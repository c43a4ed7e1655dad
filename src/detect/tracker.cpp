#include "scree/detect/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "scree/detect/obstacle_box.hpp"
#include "scree/detect/overlaps.hpp"
#include "scree/detect/push_nearest.hpp"

namespace scree {
namespace {

/// Whether two boxes may be one obstacle seen twice: the middle of one lies in the other, nearly.
bool may_be_same(const Obstacle& a, const Obstacle& b) {
  constexpr double kNear = 0.2;  // metres
  return std::min(distance_to_box(a, b.center), distance_to_box(b, a.center)) <= kNear;
}

/// The height of an obstacle, or the depth of a hole, that may be there: twice what is seen of a
/// kerb, as the surface runs from the ground before it to that behind it, and of a hole whose floor
/// is not seen. Metres.
double height_at_most(const Obstacle& obstacle) {
  constexpr double kKerb = 0.7;  // metres long
  constexpr double kHidden = 2;
  const bool is_part =
      obstacle.height > 0 ? obstacle.extent.x() >= kKerb : obstacle.evidence != Evidence::inside;
  return std::abs(obstacle.height) * (is_part ? kHidden : 1);
}

}  // namespace

Tracker::Tracker(const TrackingSettings& settings, std::size_t max_tracks,
                 std::optional<Network> network)
    : settings_(settings),
      network_(std::move(network)),
      tracks_(max_tracks),
      pairs_(16 * max_tracks),
      track_of_(max_tracks),
      published_(max_tracks),
      fragment_merger_(max_tracks),
      shown_(max_tracks),
      shown_before_(max_tracks) {}

void Tracker::update(std::int64_t stamp_ns, const Eigen::Vector3d& robot,
                     std::span<const Obstacle> found,
                     const std::function<Occupancy(const Eigen::Vector3d&)>& occupancy_at,
                     FixedVector<Obstacle>& obstacles, float turns) {
  turns_ = turns;
  if (found.size() > track_of_.capacity()) {
    dropped_ += found.size() - track_of_.capacity();
    found = found.first(track_of_.capacity());
  }
  associate(found);
  update_matched(stamp_ns, found);
  update_unmatched(occupancy_at);
  remove_lost(stamp_ns);
  start_tracks(stamp_ns, robot, found);
  classify();
  choose_published();
  list_near(robot, obstacles);
}

std::size_t Tracker::remove_if(const std::function<bool(const Obstacle&)>& has_left) {
  const std::size_t before = tracks_.size();
  const auto last = std::remove_if(tracks_.begin(), tracks_.end(),
                                   [&](const Track& track) { return has_left(track.obstacle); });
  tracks_.resize(static_cast<std::size_t>(last - tracks_.begin()));
  return before - tracks_.size();
}

void Tracker::rename(std::int64_t id, std::int64_t new_id) {
  for (Track& track : tracks_) {
    if (track.obstacle.id == id) track.obstacle.id = new_id;
  }
}

void Tracker::update_matched(std::int64_t stamp_ns, std::span<const Obstacle> found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (track_of_[i] < 0) continue;
    add_found(stamp_ns, found[i], tracks_[static_cast<std::size_t>(track_of_[i])]);
  }
}

void Tracker::update_unmatched(
    const std::function<Occupancy(const Eigen::Vector3d&)>& occupancy_at) {
  const auto smoothing = static_cast<float>(settings_.smoothing);
  for (Track& track : tracks_) {
    if (track.is_matched) continue;
    const Occupancy seen = occupancy_at(track.obstacle.center);
    // The middle of a hole is empty as long as it is there.
    track.is_seen_empty = seen == Occupancy::free && track.obstacle.height > 0;
    const float weight = track.is_seen_empty          ? std::min(2 * smoothing, 1.0F)
                         : seen == Occupancy::unknown ? 0
                                                      : smoothing;
    smooth(track.features, 0, 0, share_of(weight));
  }
}

/// Removes the tracks that were not found for long, and those without any confidence.
void Tracker::remove_lost(std::int64_t stamp_ns) {
  constexpr float kLeast = 0.02F;
  const std::int64_t remembered_ns = static_cast<std::int64_t>(settings_.remember * 1e9);
  std::size_t kept = 0;
  for (const Track& track : tracks_) {
    // Found in the future, too, when the clock was set back.
    const bool is_old = std::abs(stamp_ns - track.found_ns) >= remembered_ns;
    if (!track.is_matched && is_old) continue;
    if (track.smoothed() < kLeast) continue;
    tracks_[kept++] = track;
  }
  tracks_.resize(kept);
}

void Tracker::start_tracks(std::int64_t stamp_ns, const Eigen::Vector3d& robot,
                           std::span<const Obstacle> found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (track_of_[i] >= 0) continue;
    Track track;
    add_found(stamp_ns, found[i], track);
    track.is_matched = true;
    track.obstacle.id = 0;
    const auto distance = [&](const Track& each) { return distance_to_box(each.obstacle, robot); };
    if (!push_nearest(tracks_, track, distance)) ++dropped_;
  }
}

/// Decides which tracks are published, with hysteresis. A track gets its id when it is published
/// for the first time.
void Tracker::choose_published() {
  for (Track& track : tracks_) {
    const bool is_doubted = track.confidence < static_cast<float>(settings_.disappear);
    track.doubted = is_doubted ? track.doubted + turns_ : 0;
    if (track.is_published) {
      // Longer than a turn, unless its place was seen empty: one list that doubts it would make it
      // flicker.
      track.is_published = !is_doubted || (track.doubted <= 1 && !track.is_seen_empty);
    } else {
      // The turn that found it first counts whole.
      track.is_published = track.confidence >= static_cast<float>(settings_.appear) &&
                           track.found + 1 - turns_ >= static_cast<float>(settings_.least_found);
      if (track.is_published && track.obstacle.id == 0) track.obstacle.id = next_id_++;
    }
  }
}

/// Lists the published obstacles within reach of the robot, fragments merged, none in another. What
/// was in the list before stays in it a little longer.
void Tracker::list_near(const Eigen::Vector3d& robot, FixedVector<Obstacle>& obstacles) {
  constexpr double kStays = 0.3;       // metres beyond the reach
  constexpr double kStaysFlat = 0.75;  // of the least height
  published_.clear();
  for (const Track& track : tracks_) {
    if (!track.is_published) continue;
    published_.push_back(track.obstacle);
    published_.back().confidence = track.confidence;
  }
  std::swap(shown_, shown_before_);
  const auto was_shown = [&](const Obstacle& obstacle) {
    return std::ranges::find(shown_before_, obstacle.id) != shown_before_.end();
  };
  fragment_merger_.merge(published_);
  const auto is_flat = [&](const Obstacle& obstacle) {
    return height_at_most(obstacle) <
           settings_.least_height * (was_shown(obstacle) ? kStaysFlat : 1);
  };
  const auto last = std::remove_if(published_.begin(), published_.end(), is_flat);
  published_.resize(static_cast<std::size_t>(last - published_.begin()));
  resolve_overlaps(published_);
  shown_.clear();
  obstacles.clear();
  const auto distance = [&](const Obstacle& each) { return distance_to_box(each, robot); };
  for (const Obstacle& obstacle : published_) {
    if (distance(obstacle) > settings_.reach + (was_shown(obstacle) ? kStays : 0)) continue;
    shown_.push_back(obstacle.id);
    if (!push_nearest(obstacles, obstacle, distance)) ++dropped_;
  }
}

/// Pairs tracks with what was found, one with one, the nearest first.
void Tracker::associate(std::span<const Obstacle> found) {
  track_of_.assign(found.size(), -1);
  pairs_.clear();
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const bool was_matched = std::exchange(tracks_[t].is_matched, false);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const bool same_side = (tracks_[t].obstacle.height > 0) == (found[i].height > 0);
      if (!same_side || !may_be_same(tracks_[t].obstacle, found[i])) continue;
      const double distance = (tracks_[t].obstacle.center - found[i].center).head<2>().norm();
      const Pair pair{was_matched, static_cast<float>(distance), static_cast<std::uint32_t>(t),
                      static_cast<std::uint32_t>(i)};
      if (!pairs_.push_back(pair)) ++dropped_;
    }
  }
  // Where two tracks are on one thing, the one that had it last keeps it.
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    if (a.was_matched != b.was_matched) return a.was_matched;
    if (a.distance != b.distance) return a.distance < b.distance;
    return a.track != b.track ? a.track < b.track : a.found < b.found;
  });
  for (const Pair& pair : pairs_) {
    if (tracks_[pair.track].is_matched || track_of_[pair.found] >= 0) continue;
    tracks_[pair.track].is_matched = true;
    track_of_[pair.found] = static_cast<std::int32_t>(pair.track);
  }
}

/// Moves the smoothed confidences towards new ones.
void Tracker::smooth(Features& features, float positive, float negative, float weight) {
  features[track_positive] += weight * (positive - features[track_positive]);
  features[track_negative] += weight * (negative - features[track_negative]);
}

/// What the settings ask of a turn, for the part of it since the last list.
float Tracker::share_of(float of_a_turn) const {
  return turns_ == 1 ? of_a_turn : 1 - std::pow(1 - of_a_turn, turns_);
}

/// A track's obstacle becomes the one found, but for its id.
void Tracker::add_found(std::int64_t stamp_ns, const Obstacle& found, Track& track) const {
  // The first answers count alike.
  const float weight =
      std::max(share_of(static_cast<float>(settings_.smoothing)), turns_ / (track.found + turns_));
  const bool is_positive = found.kind == ObstacleKind::positive;
  smooth(track.features, is_positive ? found.confidence : 0, is_positive ? 0 : found.confidence,
         weight);
  const std::int64_t id = track.obstacle.id;
  track.obstacle = found;
  track.obstacle.id = id;
  track.is_seen_empty = false;
  track.found_ns = stamp_ns;
  track.found += turns_;
  float& best = track.features[track_best];
  best = std::max(best, found.confidence);
  track.features[track_height] = static_cast<float>(found.height);
}

/// Sets confidence and kind of every track. What is published fades, whatever the network answers
/// for a list that misses it.
void Tracker::classify() {
  constexpr float kMostFall = 0.2F, kMostFallEmpty = 0.4F;  // of the confidence, in a turn
  for (Track& track : tracks_) {
    track.features[track_surer] = distance_to_surer(track);
    const Prediction prediction =
        network_ ? (*network_)(track.features)
                 : Prediction{track.features[track_positive], track.features[track_negative]};
    const bool is_positive = track.obstacle.height > 0;
    const float most_fall = turns_ * (track.is_seen_empty ? kMostFallEmpty : kMostFall);
    const float least = track.is_published ? track.confidence - most_fall : 0;
    track.confidence = std::max(is_positive ? prediction.positive : prediction.negative, least);
    track.obstacle.kind = is_positive ? ObstacleKind::positive : ObstacleKind::negative;
  }
}

/// As TrackFeature has it.
float Tracker::distance_to_surer(const Track& track) const {
  constexpr double kFar = 3;
  double surer = kFar;
  for (const Track& other : tracks_) {
    if (other.smoothed() <= track.smoothed()) continue;
    const Eigen::Vector3d apart = other.obstacle.center - track.obstacle.center;
    surer = std::min(surer, apart.head<2>().norm());
  }
  return static_cast<float>(surer);
}

}  // namespace scree
