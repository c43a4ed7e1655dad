#include "simulator/faults.hpp"

#include <algorithm>
#include <cmath>

#include "scree/core/random.hpp"
#include "simulator/xbus.hpp"

namespace scree {

Faults draw_faults(double seconds, std::uint64_t seed) {
  constexpr double kHit = 0.01;  // of packets and messages
  constexpr double kBefore = 3, kBetween = 2, kAfter = 2;
  Faults faults;
  faults.packet_loss = kHit;
  faults.imu_corruption = kHit / static_cast<double>(mt_data2({}).size());
  faults.imu_gap.seconds = 2;
  faults.encoder_gap.seconds = 3;

  Random random(seed, 0xFA17);
  const bool is_imu_first = random.chance(0.5);
  Gap& first = is_imu_first ? faults.imu_gap : faults.encoder_gap;
  Gap& second = is_imu_first ? faults.encoder_gap : faults.imu_gap;
  const double free = seconds - kBefore - first.seconds - kBetween - second.seconds - kAfter;
  const double a = random.uniform(0, free);
  const double b = random.uniform(0, free);
  first.start = kBefore + std::min(a, b);
  second.start = first.end() + kBetween + std::abs(a - b);
  return faults;
}

}  // namespace scree
