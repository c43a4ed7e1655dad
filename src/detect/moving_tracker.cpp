#include "scree/detect/moving_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scree/detect/obstacle_box.hpp"
#include "scree/detect/push_nearest.hpp"

namespace scree {
namespace {

constexpr double kPlaceNoise = 0.07;   // metres: another side of it is seen
constexpr double kAcceleration = 2;    // m/s^2, of people who start and stop
constexpr double kInitialSpeed = 1.5;  // m/s, standard deviation
constexpr std::uint32_t kLeastFound = 2;
constexpr double kRemembered = 1.5;  // seconds out of sight
constexpr double kLeastWay = 0.2;    // metres from where it was seen first: then it moves

}  // namespace

MovingTracker::MovingTracker(std::size_t max_tracks) : tracks_(max_tracks), is_taken_(max_tracks) {}

void MovingTracker::update(std::int64_t stamp_ns, std::span<const Obstacle> found,
                           const std::function<bool(const Eigen::Vector3d&)>& is_seen_through,
                           std::int64_t& next_id) {
  constexpr std::uint32_t kGone = 2;  // sweeps
  predict(stamp_ns);
  associate(found, stamp_ns);
  std::size_t kept = 0;
  for (Track& track : tracks_) {
    if (!track.is_matched && is_seen_through(track.obstacle.center)) ++track.gone;
    if (track.found >= kLeastFound && track.obstacle.id == 0) track.obstacle.id = next_id++;
    const double unseen = 1e-9 * static_cast<double>(std::abs(stamp_ns - track.seen_ns));
    if (track.gone >= kGone || unseen > kRemembered) continue;
    if (!track.is_matched && track.found < kLeastFound) continue;
    tracks_[kept++] = track;
  }
  tracks_.resize(kept);
}

void MovingTracker::predict(std::int64_t stamp_ns) {
  const double seconds = std::clamp(1e-9 * static_cast<double>(stamp_ns - stamp_ns_), 0.0, 1.0);
  stamp_ns_ = stamp_ns;
  constexpr double kNoise = kAcceleration * kAcceleration;
  const double square = seconds * seconds;
  for (Track& track : tracks_) {
    track.obstacle.center.head<2>() += seconds * track.velocity;
    for (Eigen::Vector2d& corner : track.obstacle.footprint) corner += seconds * track.velocity;
    track.place_variance += 2 * seconds * track.covariance + square * track.velocity_variance +
                            kNoise * square * square / 4;
    track.covariance += seconds * track.velocity_variance + kNoise * square * seconds / 2;
    track.velocity_variance += kNoise * square;
  }
}

/// Each thing found belongs to the nearest track, the nearest pair first.
void MovingTracker::associate(std::span<const Obstacle> found, std::int64_t stamp_ns) {
  constexpr double kGate = 0.6;  // metres beside what the filter expects
  found = found.first(std::min(found.size(), is_taken_.capacity()));
  is_taken_.assign(found.size(), 0);
  for (Track& track : tracks_) track.is_matched = false;
  while (true) {
    double nearest = 1;
    Track* best = nullptr;
    std::size_t which = 0;
    for (Track& track : tracks_) {
      if (track.is_matched) continue;
      const double gate = kGate + std::min(std::sqrt(track.place_variance), kGate);
      for (std::size_t i = 0; i < found.size(); ++i) {
        if (is_taken_[i] != 0) continue;
        const double apart = (found[i].center - track.obstacle.center).head<2>().norm() / gate;
        if (apart >= nearest) continue;
        nearest = apart;
        best = &track;
        which = i;
      }
    }
    if (best == nullptr) break;
    is_taken_[which] = 1;
    add_found(found[which], stamp_ns, *best);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (is_taken_[i] != 0) continue;
    Track track;
    track.obstacle = found[i];
    track.obstacle.id = 0;
    track.start = found[i].center.head<2>();
    track.place_variance = kPlaceNoise * kPlaceNoise;
    track.velocity_variance = kInitialSpeed * kInitialSpeed;
    track.seen_ns = stamp_ns;
    track.found = 1;
    track.is_matched = true;
    if (!tracks_.push_back(track)) ++dropped_;
  }
}

void MovingTracker::add_found(const Obstacle& found, std::int64_t stamp_ns, Track& track) {
  const double innovation = track.place_variance + kPlaceNoise * kPlaceNoise;
  const double gain = track.place_variance / innovation;
  const double velocity_gain = track.covariance / innovation;
  const Eigen::Vector2d predicted = track.obstacle.center.head<2>();
  const Eigen::Vector2d off = found.center.head<2>() - predicted;
  const std::int64_t id = track.obstacle.id;
  track.obstacle = found;
  track.obstacle.id = id;
  track.velocity += velocity_gain * off;
  track.velocity_variance -= velocity_gain * track.covariance;
  track.covariance *= 1 - gain;
  track.place_variance *= 1 - gain;
  track.seen_ns = stamp_ns;
  track.gone = 0;
  ++track.found;
  track.is_matched = true;
}

void MovingTracker::add_to(FixedVector<Obstacle>& list, const Eigen::Vector3d& robot,
                           Tracker& standing) {
  constexpr double kSame = 0.2;  // metres
  hand_over(list, standing);
  for (const Track& track : tracks_) {
    if (track.obstacle.id == 0) continue;
    const auto last = std::remove_if(list.begin(), list.end(), [&](const Obstacle& other) {
      return other.velocity.isZero() && distance_to_box(track.obstacle, other.center) < kSame;
    });
    list.resize(static_cast<std::size_t>(last - list.begin()));
    const auto distance = [&](const Obstacle& each) { return distance_to_box(each, robot); };
    if (!push_nearest(list, published(track), distance)) ++dropped_;
  }
}

bool MovingTracker::was_left(const Obstacle& standing) const {
  constexpr double kBeside = 0.5;  // metres from its way
  constexpr double kBefore = 1;    // metres: where it stood, nothing was clear around it
  const Eigen::Vector2d place = standing.center.head<2>();
  return std::ranges::any_of(tracks_, [&](const Track& track) {
    const Eigen::Vector2d way = track.obstacle.center.head<2>() - track.start;
    const double length = way.norm();
    if (track.obstacle.id == 0 || length < kLeastWay) return false;
    if (distance_to_box(track.obstacle, standing.center) == 0) return false;
    const Eigen::Vector2d ahead = way / length;
    const double along = std::clamp((place - track.start).dot(ahead), -kBefore, length);
    return (place - track.start - along * ahead).norm() < kBeside;
  });
}

/// What moved and stands now has come into the map.
void MovingTracker::hand_over(FixedVector<Obstacle>& list, Tracker& standing) {
  constexpr double kNear = 0.3;  // metres
  for (Obstacle& obstacle : list) {
    if (obstacle.kind != ObstacleKind::positive) continue;
    const auto track = std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& each) {
      return !each.is_matched && each.obstacle.id != 0 &&
             distance_to_box(each.obstacle, obstacle.center) <= kNear;
    });
    if (track == tracks_.end()) continue;
    standing.rename(obstacle.id, track->obstacle.id);
    obstacle.id = track->obstacle.id;
    std::move(track + 1, tracks_.end(), track);
    tracks_.resize(tracks_.size() - 1);
  }
}

/// As it is published: with a velocity only where it surely moves.
Obstacle MovingTracker::published(const Track& track) {
  constexpr double kLeastSpeed = 0.25;  // m/s
  Obstacle obstacle = track.obstacle;
  const double deviation = std::sqrt(track.velocity_variance);
  const double way = (obstacle.center.head<2>() - track.start).norm();
  const bool moves =
      track.velocity.norm() > std::max(kLeastSpeed, 2 * deviation) && way > kLeastWay;
  obstacle.velocity = moves ? track.velocity : Eigen::Vector2d::Zero();
  return obstacle;
}

}  // namespace scree
