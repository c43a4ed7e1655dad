#include "simulator/beam.hpp"

#include <algorithm>
#include <cmath>

namespace scree {

const FixedVector<Echo>& Beam::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                    const Eigen::Vector3d& left, const Eigen::Vector3d& up,
                                    Random& random) {
  constexpr double kAside = 0.0012;  // rad: where the outer parts of the light have their middle
  constexpr double kAbove = 0.0006;
  echoes_.clear();
  if (!add(origin, direction, 0.4, random)) return echoes_;
  add(origin, (direction + kAside * left).normalized(), 0.15, random);
  add(origin, (direction - kAside * left).normalized(), 0.15, random);
  const auto [near, far] =
      std::minmax_element(echoes_.begin(), echoes_.end(),
                          [](const Echo& a, const Echo& b) { return a.range < b.range; });
  // What lies above and below matters where there is an edge.
  constexpr double kEven = 0.03;
  if (echoes_.size() < 3 || far->range - near->range > kEven) {
    add(origin, (direction + kAbove * up).normalized(), 0.15, random);
    add(origin, (direction - kAbove * up).normalized(), 0.15, random);
  } else {
    for (Echo& echo : echoes_) echo.light *= 1 / 0.7;
  }
  blend();
  return echoes_;
}

bool Beam::add(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double share,
               Random& random) {
  const auto ground = caster_.cast(origin, direction, reach_);
  auto met = terrain_.volumes().cast(origin, direction, ground.value_or(reach_), random);
  if (movers_ != nullptr) {
    const double free = met ? met->range : ground.value_or(reach_);
    if (const auto mover = movers_->cast(origin, direction, free)) met = mover;
  }
  if (!ground && !met) return false;
  if (met && met->volume->is_dark) return false;
  Echo echo;
  echo.range = met ? met->range : *ground;
  double facing = 0.6;  // blades face all ways
  if (met) {
    const Volume& volume = *met->volume;
    const Eigen::Vector3d hit = origin + met->range * direction;
    echo.reflectivity = random.uniform(volume.darkest, volume.brightest);
    if (volume.density == Volume::kSolid) {
      facing = std::max(-direction.dot(volume.normal(hit)), 0.0);
    }
    // What hangs higher says nothing of what stands below.
    constexpr double kHighest = 2;
    const double up = terrain_.above_ground(hit);
    if (volume.part != 0 && up < kHighest) {
      echo.part = volume.part;
      echo.relief = static_cast<float>(up);
    }
  } else {
    const Eigen::Vector3d hit = origin + *ground * direction;
    const double air = terrain_.underside(hit.x(), hit.y());
    const bool is_below = air > 0 && terrain_.above_ground(hit) < air / 2;
    // The normal is that of a rock's top.
    if (air <= 0) facing = std::max(-direction.dot(terrain_.normal(hit.x(), hit.y())), 0.0);
    echo.reflectivity = terrain_.reflectivity(hit.x(), hit.y());
    if (echo.reflectivity == 0) return false;
    // On the very brink of a hole, or on a rock's skirt, nothing is seen of it yet.
    constexpr double kTelling = 0.05;
    const double relief = is_below ? 0 : terrain_.relief(hit.x(), hit.y());
    echo.relief = static_cast<float>(relief);
    const std::uint16_t part = terrain_.part_at(hit.x(), hit.y());
    if (std::abs(relief) > kTelling || terrain_.is_of_edge(part)) echo.part = part;
  }
  // Against a threshold that a level, dark ground 30 m away hardly passes.
  constexpr double kThreshold = 0.0015;
  const double light = (0.05 + echo.reflectivity / 100) * facing * 100 / (echo.range * echo.range);
  echo.light = share * light / kThreshold;
  echo.reflectivity *= 0.6 + 0.4 * facing;
  echoes_.push_back(echo);
  return true;
}

void Beam::blend() {
  constexpr double kPulse = 0.8;  // metres: a pulse of 5 ns, out and back
  std::sort(echoes_.begin(), echoes_.end(),
            [](const Echo& a, const Echo& b) { return a.range < b.range; });
  std::size_t groups = 0;
  for (std::size_t i = 0; i < echoes_.size();) {
    const double nearest = echoes_[i].range;
    Echo blended;
    double brightest = 0;
    for (; i < echoes_.size() && echoes_[i].range - nearest < kPulse; ++i) {
      const Echo& part = echoes_[i];
      blended.light += part.light;
      blended.range += part.light * part.range;
      blended.reflectivity += part.light * part.reflectivity;
      if (part.light <= brightest) continue;
      brightest = part.light;
      blended.part = part.part;
      blended.relief = part.relief;
    }
    if (blended.light <= 0) continue;
    blended.range /= blended.light;
    blended.reflectivity /= blended.light;
    echoes_[groups++] = blended;
  }
  echoes_.resize(groups);
}

}  // namespace scree
