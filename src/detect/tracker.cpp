#include "scree/detect/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "scree/detect/obstacle_box.hpp"
#include "scree/detect/overlaps.hpp"

namespace scree {
namespace {

/// Whether two boxes may be one obstacle seen twice: the middle of one lies in the other, nearly.
bool may_be_same(const Obstacle& a, const Obstacle& b) {
  constexpr double kNear = 0.2;  // metres
  return std::min(distance_to_box(a, b.center), distance_to_box(b, a.center)) <= kNear;
}

}  // namespace

Tracker::Tracker(const TrackingSettings& settings, std::size_t max_tracks,
                 std::optional<Network> judge)
    : settings_(settings),
      judge_(std::move(judge)),
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
                     FixedVector<Obstacle>& obstacles) {
  if (found.size() > track_of_.capacity()) {
    dropped_ += found.size() - track_of_.capacity();
    found = found.first(track_of_.capacity());
  }
  match(found);
  const auto share = static_cast<float>(settings_.smoothing);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (track_of_[i] >= 0) {
      learn(tracks_[static_cast<std::size_t>(track_of_[i])], &found[i], share);
      tracks_[static_cast<std::size_t>(track_of_[i])].found_ns = stamp_ns;
    }
  }
  const std::int64_t remembered_ns = static_cast<std::int64_t>(settings_.remember * 1e9);
  std::size_t kept = 0;
  for (Track& track : tracks_) {
    if (!track.is_matched) {
      const Occupancy seen = occupancy_at(track.obstacle.center);
      // The middle of a hole is empty as long as it is there.
      track.is_seen_empty = seen == Occupancy::free && track.obstacle.height > 0;
      learn(track, nullptr,
            track.is_seen_empty          ? std::min(2 * share, 1.0F)
            : seen == Occupancy::unknown ? 0
                                         : share);
      // From the future, too, when the clock was set back.
      if (std::abs(stamp_ns - track.found_ns) >= remembered_ns) continue;
    }
    if (track.smoothed() < 0.02F) continue;
    tracks_[kept++] = track;
  }
  tracks_.resize(kept);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (track_of_[i] >= 0) continue;
    Track track;
    learn(track, &found[i], share);
    track.found_ns = stamp_ns;
    track.is_matched = true;
    track.obstacle.id = 0;
    if (!tracks_.push_back(track)) ++dropped_;
  }
  judge();

  obstacles.clear();
  for (Track& track : tracks_) {
    const bool was_doubted = track.is_doubted;
    track.is_doubted = track.confidence < static_cast<float>(settings_.disappear);
    if (track.is_published) {
      // Twice, unless its place was seen empty: one list that doubts it would make it flicker.
      track.is_published = !track.is_doubted || (!was_doubted && !track.is_seen_empty);
    } else {
      track.is_published = track.confidence >= static_cast<float>(settings_.appear) &&
                           track.found >= settings_.least_found;
      if (track.is_published && track.obstacle.id == 0) track.obstacle.id = next_id_++;
    }
  }
  published_.clear();
  for (const Track& track : tracks_) {
    if (!track.is_published) continue;
    published_.push_back(track.obstacle);
    published_.back().confidence = track.confidence;
  }
  fragment_merger_.merge(published_);
  resolve_overlaps(published_);
  constexpr double kStays = 0.3;  // metres beyond the reach, of what was in the list before
  std::swap(shown_, shown_before_);
  shown_.clear();
  for (const Obstacle& obstacle : published_) {
    const bool was_shown = std::ranges::find(shown_before_, obstacle.id) != shown_before_.end();
    const double reach = settings_.reach + (was_shown ? kStays : 0);
    if (distance_to_box(obstacle, robot) > reach) continue;
    shown_.push_back(obstacle.id);
    if (!obstacles.push_back(obstacle)) ++dropped_;
  }
}

void Tracker::match(std::span<const Obstacle> found) {
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
  // Of two tracks on one thing the one that had it last keeps it.
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

/// Moves the confidences towards those of what was found, or towards none.
void Tracker::learn(Track& track, const Obstacle* found, float share) const {
  const bool is_positive = found != nullptr && found->kind == ObstacleKind::positive;
  const float confidence = found != nullptr ? found->confidence : 0;
  // The first answers count alike.
  const float weight =
      found != nullptr ? std::max(share, 1.0F / static_cast<float>(track.found + 1)) : share;
  float& positive = track.features[track_positive];
  float& negative = track.features[track_negative];
  positive += weight * ((is_positive ? confidence : 0) - positive);
  negative += weight * ((is_positive ? 0 : confidence) - negative);
  if (found == nullptr) return;
  const std::int64_t id = track.obstacle.id;
  track.obstacle = *found;
  track.obstacle.id = id;
  track.is_seen_empty = false;
  ++track.found;
  float& best = track.features[track_best];
  best = std::max(best, confidence);
  track.features[track_height] = static_cast<float>(found->height);
}

/// Confidence and kind of every track. What is published fades, whatever the judge thinks of a
/// list that misses it.
void Tracker::judge() {
  constexpr float kMostFall = 0.2F, kMostFallEmpty = 0.4F;  // of the confidence, in a list
  for (Track& track : tracks_) {
    constexpr double kFar = 3;
    double surer = kFar;
    for (const Track& other : tracks_) {
      if (other.smoothed() <= track.smoothed()) continue;
      const Eigen::Vector3d apart = other.obstacle.center - track.obstacle.center;
      surer = std::min(surer, apart.head<2>().norm());
    }
    track.features[track_surer] = static_cast<float>(surer);
    const Prediction prediction =
        judge_ ? (*judge_)(track.features)
               : Prediction{track.features[track_positive], track.features[track_negative]};
    const float most_fall = track.is_seen_empty ? kMostFallEmpty : kMostFall;
    const float least = track.is_published ? track.confidence - most_fall : 0;
    track.confidence = std::max(prediction.confidence(), least);
    track.obstacle.kind = prediction.kind();
  }
}

}  // namespace scree
