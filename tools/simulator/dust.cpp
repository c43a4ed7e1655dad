#include "simulator/dust.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

constexpr std::int64_t kLifeNs = 5'000'000'000;

}  // namespace

Dust::Dust(double puffs, const Motion& motion, std::int64_t start_ns, std::uint64_t seed)
    : puffs_(puffs), motion_(motion), random_(seed, 0xD057), now_ns_(start_ns) {
  const double angle = random_.uniform(0, 2 * std::numbers::pi), speed = random_.uniform(0, 0.6);
  wind_ = {speed * std::cos(angle), speed * std::sin(angle), 0};
  densest_ = random_.uniform(1, 8);
}

void Dust::advance(std::int64_t t_ns) {
  if (puffs_ <= 0) return;
  due_ += puffs_ * (motion_.distance(t_ns) - motion_.distance(now_ns_));
  now_ns_ = t_ns;
  for (; due_ >= 1; due_ -= 1) {
    constexpr double kWheelsAhead = 0.4, kWheelsAside = 0.3;
    const double ahead = random_.chance(0.5) ? kWheelsAhead : -kWheelsAhead;
    const double aside = random_.chance(0.5) ? kWheelsAside : -kWheelsAside;
    Puff puff;
    puff.born_ns = t_ns;
    puff.place = motion_.base(t_ns) * Eigen::Vector3d(ahead, aside, 0.1);
    puff.drift = wind_ + Eigen::Vector3d(random_.uniform(-0.2, 0.2), random_.uniform(-0.2, 0.2),
                                         random_.uniform(0, 0.5));
    puff.radius = random_.uniform(0.08, 0.2);
    puff.growth = random_.uniform(0.05, 0.3);
    puff.density = densest_ * random_.uniform(0.2, 1);
    alive_.push_back(puff);
  }
  while (!alive_.empty() && t_ns - alive_.front().born_ns > kLifeNs) alive_.pop_front();
}

std::optional<double> Dust::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                 std::int64_t t_ns, double max_range) {
  double nearest = max_range;
  for (const Puff& puff : alive_) {
    const double age = static_cast<double>(t_ns - puff.born_ns) * 1e-9;
    const double radius = puff.radius + puff.growth * age;
    const Eigen::Vector3d to = puff.place + puff.drift * age - origin;
    const double middle = to.dot(direction);
    const double square = radius * radius - (to.squaredNorm() - middle * middle);
    if (square <= 0) continue;
    const double half = std::sqrt(square), from = std::max(middle - half, 0.0);
    // The same grains in a larger room, and fewer of them: they settle.
    const double share = puff.radius / radius, left = 1 - age * 1e9 / static_cast<double>(kLifeNs);
    const double density = puff.density * share * share * share * std::max(left, 0.0);
    const double range = from - std::log(1 - random_.uniform()) / density;
    if (density > 0 && range < middle + half) nearest = std::min(nearest, range);
  }
  if (nearest < max_range) return nearest;
  return std::nullopt;
}

}  // namespace scree
