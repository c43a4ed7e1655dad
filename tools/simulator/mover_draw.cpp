#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "scree/core/random.hpp"
#include "simulator/building.hpp"
#include "simulator/curves.hpp"
#include "simulator/movers.hpp"

// What moves, how it looks, and which way it takes.
namespace scree {
namespace {

constexpr std::int64_t kStepNs = 50'000'000;
constexpr double kStep = 0.05;  // seconds

Volume ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  Volume volume;
  volume.center = center;
  volume.half = half;
  volume.density = Volume::kSolid;
  return volume;
}

void finish(Mover& mover, double half_length, double half_width, double height, Random& random) {
  mover.footprint = rectangle({0, 0}, {half_length, half_width}, 0);
  mover.radius = std::hypot(half_length, half_width);
  mover.height = height;
  const double brightness = random.uniform(8, 60);
  for (Volume& body : mover.bodies) {
    body.darkest = 0.8 * brightness;
    body.brightest = 1.2 * brightness;
  }
}

/// Measures of adults and children: the share of the height as of a mean adult.
Mover person(Random& random) {
  const double height = random.chance(0.2) ? random.uniform(1.1, 1.5) : random.uniform(1.55, 1.95);
  const double scale = height / 1.75, girth = scale * random.uniform(0.85, 1.25);
  Mover mover;
  mover.name = "person";
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d hip(0, side * 0.09 * girth, 0.85 * scale);
    const Eigen::Vector3d foot(side * 0.15 * scale, side * 0.1 * girth, 0);
    mover.bodies.push_back(Volume::rod(foot, hip, 0.08 * girth));
    const Eigen::Vector3d shoulder(0, side * 0.22 * girth, 1.42 * scale);
    const Eigen::Vector3d hand(-side * 0.15 * scale, side * 0.27 * girth, 0.8 * scale);
    mover.bodies.push_back(Volume::rod(hand, shoulder, 0.05 * girth));
  }
  mover.bodies.push_back(
      ellipsoid({0, 0, 1.12 * scale}, {0.14 * girth, 0.21 * girth, 0.36 * scale}));
  mover.bodies.push_back(ellipsoid({0, 0, 1.62 * scale}, {0.1, 0.09, 0.13 * scale}));
  finish(mover, 0.2 * girth, 0.27 * girth, height, random);
  return mover;
}

/// From a dog to a deer.
Mover animal(Random& random) {
  const double height = random.uniform(0.45, 1.1);
  const double half_length = height * random.uniform(0.5, 0.7), half_width = 0.2 * height;
  Mover mover;
  mover.name = "animal";
  for (const double end : {-0.75, 0.75}) {
    for (const double side : {-0.6, 0.6}) {
      const Eigen::Vector3d foot(end * half_length, side * half_width, 0);
      mover.bodies.push_back(
          Volume::rod(foot, foot + Eigen::Vector3d(0, 0, 0.6 * height), 0.05 * height));
    }
  }
  mover.bodies.push_back(ellipsoid({0, 0, 0.68 * height}, {half_length, half_width, 0.2 * height}));
  mover.bodies.push_back(ellipsoid({1.05 * half_length, 0, 0.88 * height},
                                   {0.22 * height, 0.1 * height, 0.12 * height}));
  finish(mover, 1.2 * half_length, half_width, height, random);
  return mover;
}

/// From a cart to a car.
Mover vehicle(Random& random) {
  const double half_length = random.uniform(0.8, 2.3);
  const double half_width = std::min(random.uniform(0.45, 0.95), 0.6 * half_length);
  const double height = random.uniform(1.1, 1.8), below = random.uniform(0.12, 0.3);
  const double waist = random.uniform(0.5, 0.65) * height;
  Mover mover;
  mover.name = "vehicle";
  const auto box = [&](double along, double half, double low, double high) {
    return Volume::block({along, 0, (low + high) / 2}, {half, half_width, (high - low) / 2}, 0);
  };
  mover.bodies.push_back(box(0, half_length, below, waist));
  mover.bodies.push_back(box(-0.15 * half_length, 0.5 * half_length, waist, height));
  for (const double end : {-0.65, 0.65}) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d outside(end * half_length, side * half_width, 0.25);
      mover.bodies.push_back(
          Volume::rod(outside - Eigen::Vector3d(0, side * 0.15, 0), outside, 0.25));
    }
  }
  finish(mover, half_length, half_width, height, random);
  return mover;
}

/// The speed over time: with a pause, at its end or at its beginning perhaps.
class Gait {
public:
  Gait(double speed, double meets, Random& random) : speed_(speed) {
    if (random.chance(0.35)) {
      pause_begin_ = meets + random.uniform(-2, 2);
      pause_end_ = random.chance(0.4) ? 1e9 : pause_begin_ + random.uniform(1.5, 4);
    }
    if (random.chance(0.25)) begins_ = meets - random.uniform(1, 4);
  }
  double operator()(double t) const {
    const auto risen = [&](double since) { return std::clamp(since / kStarting, 0.0, 1.0); };
    return speed_ * risen(t - begins_) *
           std::max(1 - risen(t - pause_begin_), risen(t - pause_end_));
  }

private:
  static constexpr double kStarting = 0.7;  // seconds
  double speed_;
  double begins_ = -1e9, pause_begin_ = 1e9, pause_end_ = 1e9;
};

/// A line that something could walk along, metres from where it meets the robot's way.
struct Line {
  Eigen::Vector2d crossing, along;
  double bend, wavelength;
  double from = 0, to = 0;  ///< how far nothing stands in the way

  Eigen::Vector2d at(double s) const {
    const Eigen::Vector2d aside(-along.y(), along.x());
    return crossing + s * along + bend * std::sin(kTurn * s / wavelength) * aside;
  }
};

class WayDrawing {
public:
  WayDrawing(const Terrain& terrain, const Motion& robot, std::int64_t start_ns,
             std::int64_t end_ns, Random& random)
      : terrain_(terrain), robot_(robot), start_ns_(start_ns), end_ns_(end_ns), random_(random) {}

  /// False when none was found.
  bool draw(Mover& mover, double speed, std::span<const Mover> others) {
    constexpr int kTries = 150;
    constexpr double kShortest = 3;  // metres
    for (int i = 0; i < kTries; ++i) {
      const double meets = random_.uniform(0.1, 0.95) * seconds();
      Line line = draw_line(meets);
      line.to = free_way(line, mover, 1);
      line.from = -free_way(line, mover, -1);
      const Gait gait(speed, meets, random_);
      if (line.to - line.from < kShortest) continue;
      mover.track = walk(line, gait, meets);
      if (is_clear(mover, others)) return true;
    }
    return false;
  }

private:
  double seconds() const { return 1e-9 * static_cast<double>(end_ns_ - start_ns_); }

  Line draw_line(double meets) {
    const Pose base = robot_.base(start_ns_ + static_cast<std::int64_t>(meets * 1e9));
    const Eigen::Vector3d ahead = base.rotation * Eigen::Vector3d::UnitX();
    const double heading = std::atan2(ahead.y(), ahead.x());
    const double far = random_.uniform(2.2, 7.5), aside = random_.uniform(-0.6, 0.6);
    const double across = (random_.chance(0.5) ? kTurn : -kTurn) / 4 + random_.uniform(-0.7, 0.7);
    const double turn = random_.chance(0.25) ? random_.uniform(0, kTurn) : across;
    return {base.translation.head<2>() + far * unit_vector(heading + aside),
            unit_vector(heading + turn), random_.uniform(0, 0.4), random_.uniform(4, 10)};
  }

  /// How far it can walk to one side, metres.
  double free_way(const Line& line, const Mover& mover, double side) const {
    constexpr double kFarthest = 40, kStride = 0.1;
    double way = 0;
    while (way < kFarthest && has_room(line.at(side * (way + kStride)), mover)) way += kStride;
    return way;
  }

  /// Grass and stones are walked over.
  bool has_room(const Eigen::Vector2d& at, const Mover& mover) const {
    constexpr double kGap = 0.5, kFar = 10;  // metres; beyond the radius of what is not long
    if (!terrain_.covers(at.x(), at.y())) return false;
    const double reach = mover.radius + kGap, ground = terrain_.height(at.x(), at.y());
    for (const TerrainFeature& feature : terrain_.features()) {
      if (!feature.kind || feature.is_small) continue;
      if (!feature.is_long() && (feature.center.head<2>() - at).norm() > kFar) continue;
      if (distance(feature.footprint, at) < reach) return false;
    }
    bool is_free = true;
    for (const Eigen::Vector2d& side :
         {Eigen::Vector2d(0, 0), Eigen::Vector2d(reach, 0), Eigen::Vector2d(-reach, 0),
          Eigen::Vector2d(0, reach), Eigen::Vector2d(0, -reach)}) {
      terrain_.volumes().for_each_near(
          at.x() + side.x(), at.y() + side.y(), [&](const Volume& each) {
            const Eigen::Vector3d half = each.reach();
            if (each.part == 0 || each.center.z() - half.z() > ground + mover.height) return;
            const double away = (each.center.head<2>() - at).norm();
            if (away < half.head<2>().maxCoeff() + reach) is_free = false;
          });
    }
    return is_free;
  }

  /// It slows down before what stands in its way.
  std::vector<TrueObstacle::Place> walk(const Line& line, const Gait& gait, double meets) const {
    constexpr double kBraking = 1.5;  // m/s^2
    const auto steps = static_cast<int>(std::lround(seconds() / kStep)) + 2;
    const auto met = std::clamp(static_cast<int>(std::lround(meets / kStep)), 0, steps - 1);
    std::vector<double> way(static_cast<std::size_t>(steps), 0);
    for (const int side : {1, -1}) {
      for (int i = met + side; i >= 0 && i < steps; i += side) {
        const double before = way[static_cast<std::size_t>(i - side)];
        const double left = std::max(side > 0 ? line.to - before : before - line.from, 0.0);
        const double speed = std::min(gait(i * kStep), std::sqrt(2 * kBraking * left));
        way[static_cast<std::size_t>(i)] = before + side * std::min(speed * kStep, left);
      }
    }
    std::vector<TrueObstacle::Place> track;
    for (int i = 0; i < steps; ++i) {
      constexpr double kLookAhead = 0.05;  // metres
      const double s = way[static_cast<std::size_t>(i)];
      const Eigen::Vector2d here = line.at(s), towards = line.at(s + kLookAhead) - here;
      track.push_back({start_ns_ + i * kStepNs, here, std::atan2(towards.y(), towards.x())});
    }
    return track;
  }

  /// Of the robot and of others at all times.
  bool is_clear(const Mover& mover, std::span<const Mover> others) const {
    constexpr double kFromRobot = 1.2, kFromOthers = 0.3;  // metres
    for (std::size_t i = 0; i < mover.track.size(); ++i) {
      const auto& [t_ns, at, yaw] = mover.track[i];
      const Eigen::Vector2d robot = robot_.base(t_ns).translation.head<2>();
      if ((at - robot).norm() < kFromRobot + mover.radius) return false;
      for (const Mover& other : others) {
        const double apart = (other.track[i].position - at).norm();
        if (apart < other.radius + mover.radius + kFromOthers) return false;
      }
    }
    return true;
  }

  const Terrain& terrain_;
  const Motion& robot_;
  std::int64_t start_ns_, end_ns_;
  Random& random_;
};

}  // namespace

std::vector<Mover> draw_movers(const MoverCounts& counts, const Terrain& terrain,
                               const Motion& robot, std::int64_t start_ns, std::int64_t end_ns,
                               std::uint64_t seed) {
  Random random(seed, 0x3073);
  WayDrawing drawing(terrain, robot, start_ns, end_ns, random);
  std::vector<Mover> movers;
  const auto add = [&](Mover mover, double speed) {
    if (drawing.draw(mover, speed, movers)) movers.push_back(std::move(mover));
  };
  for (int i = 0; i < counts.people; ++i) {
    add(person(random), random.chance(0.1) ? random.uniform(1.8, 3) : random.uniform(0.5, 1.8));
  }
  for (int i = 0; i < counts.animals; ++i) add(animal(random), random.uniform(0.5, 3));
  for (int i = 0; i < counts.vehicles; ++i) add(vehicle(random), random.uniform(1, 5));
  return movers;
}

}  // namespace scree
