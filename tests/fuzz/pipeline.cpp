// The whole pipeline on values that sensors may send but never should: points anywhere within the
// lidar's reach, a wheel that jumps, an IMU that tumbles, times with gaps. Lists are finite. The
// map is small, so that a run takes milliseconds.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>

#include "memory_file.hpp"
#include "scree/app/pipeline.hpp"

namespace {

using namespace scree;

Settings small() {
  Settings settings;
  settings.memory = {.sweep_points = 512,
                     .map_voxels = 1024,
                     .cloud_points = 1024,
                     .ground_cells = 1024,
                     .obstacles = 16};
  settings.map.reach = settings.map.search_reach = 4;
  settings.map.registration_reach = 4;
  settings.map.voxel = 0.2;
  return settings;
}

double any(FuzzedDataProvider& input, double most) {
  const double value = input.ConsumeFloatingPointInRange(-most, most);
  return input.ConsumeIntegralInRange(0, 49) == 0 ? input.ConsumeFloatingPoint<double>() : value;
}

ImuSample imu_of(FuzzedDataProvider& input, std::int64_t t_ns) {
  ImuSample sample;
  sample.t_ns = t_ns;
  sample.has_orientation = input.ConsumeIntegralInRange(0, 9) != 0;
  sample.has_rate = input.ConsumeBool();
  sample.has_acceleration = input.ConsumeBool();
  sample.orientation =
      Eigen::Quaterniond(any(input, 1), any(input, 1), any(input, 1), any(input, 1));
  sample.orientation.normalize();
  if (!sample.orientation.coeffs().allFinite()) sample.orientation.setIdentity();
  for (int i = 0; i < 3; ++i) sample.rate[i] = any(input, 40);
  for (int i = 0; i < 3; ++i) sample.acceleration[i] = any(input, 100);
  return sample;
}

/// Level ground around the lidar, and some points anywhere.
void fill(FuzzedDataProvider& input, Sweep& sweep) {
  sweep.clear();
  const auto ground = input.ConsumeIntegralInRange<std::size_t>(0, 300);
  const float height = input.ConsumeFloatingPointInRange(-2.0F, 0.0F);
  for (std::size_t i = 0; i < ground; ++i) {
    const float azimuth = 0.1F * static_cast<float>(i), range = 1 + 0.01F * static_cast<float>(i);
    sweep.push_back({range * std::cos(azimuth), range * std::sin(azimuth), height}, 10,
                    -static_cast<std::int32_t>(300 - i) * 1000, i % 16);
  }
  for (int i = input.ConsumeIntegralInRange(0, 20); i > 0; --i) {
    const auto part = [&] { return input.ConsumeFloatingPointInRange(-130.0F, 130.0F); };
    const Eigen::Vector3f at(part(), part(), part());
    sweep.push_back(at, 255, 0, input.ConsumeIntegralInRange<std::size_t>(0, 15));
  }
}

void check(const ObstacleList& list) {
  fuzz::require(list.pose.translation.allFinite() && list.pose.rotation.coeffs().allFinite());
  for (const Obstacle& obstacle : list.obstacles) {
    fuzz::require(obstacle.center.allFinite() && obstacle.extent.allFinite());
    fuzz::require(std::isfinite(obstacle.yaw) && std::isfinite(obstacle.height));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider input(bytes, size);
  static const Settings settings = small();
  static const Networks networks;
  Pipeline pipeline(settings, networks);
  Sweep sweep(512);
  std::int64_t now_ns = 1'000'000'000'000;
  double way = 0;
  for (int turn = 0; turn < 8 && input.remaining_bytes() > 0; ++turn) {
    const std::int64_t end_ns =
        now_ns + (input.ConsumeIntegralInRange(0, 9) == 0
                      ? input.ConsumeIntegralInRange<std::int64_t>(1, 100'000'000'000)
                      : 100'000'000);
    for (std::int64_t t_ns = now_ns; t_ns <= now_ns + 100'000'000; t_ns += 20'000'000) {
      pipeline.sensors().put(imu_of(input, t_ns));
      way += input.ConsumeFloatingPointInRange(-0.2, 0.2);
      const double reading = way + any(input, 0.01);
      pipeline.sensors().put(EncoderSample{t_ns, 0, reading, reading});
    }
    fill(input, sweep);
    sweep.end_ns = end_ns;
    sweep.is_whole = input.ConsumeIntegralInRange(0, 9) != 0;
    check(pipeline.process(sweep));
    now_ns = end_ns;
  }
  return 0;
}
