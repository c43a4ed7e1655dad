#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>

#include "scree/core/rotation.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace scree {
namespace {

constexpr std::int64_t kSamples = 200'000, kStep = 1'000'000;

double yaw_at(std::int64_t i) {
  return 1e-3 * static_cast<double>(i % 3000);
}

/// Carried along only.
double acceleration_of(std::int64_t i) {
  return static_cast<double>(i % 200);
}

/// Two sensors' threads and the detector's, as fast as they can. What the detector sees is whole,
/// in order, and nothing is lost that was not counted.
TEST(SyncThreads, OneProducerForEachSensorAndOneConsumer) {
  const auto buffer = std::make_unique<SyncBuffer>();
  std::atomic<std::int64_t> imu_refused{0}, wheel_refused{0};
  std::atomic<int> running{2};
  std::jthread imu([&] {
    for (std::int64_t i = 1; i <= kSamples; ++i) {
      ImuSample sample;
      sample.t_ns = i * kStep;
      sample.has_orientation = true;
      sample.orientation = exponential({0, 0, yaw_at(i)});
      sample.has_acceleration = true;
      sample.acceleration.setConstant(acceleration_of(i));
      if (!buffer->put(sample)) ++imu_refused;
    }
    --running;
  });
  std::jthread wheel([&] {
    for (std::int64_t i = 1; i <= kSamples; ++i) {
      EncoderSample sample;
      sample.t_ns = i * kStep;
      sample.raw = i;
      sample.distance = static_cast<double>(i);
      if (!buffer->put(sample)) ++wheel_refused;
    }
    --running;
  });

  std::int64_t imu_taken = 0, wheel_taken = 0, imu_until = 0, wheel_until = 0;
  bool is_done = false;
  while (!is_done) {
    is_done = running == 0;  // looked at before: what was put until then is gathered below
    buffer->gather();
    for (std::size_t i = buffer->imu().count_until(imu_until); i < buffer->imu().size(); ++i) {
      const ImuSample& sample = buffer->imu()[i];
      const std::int64_t number = sample.t_ns / kStep;
      ASSERT_EQ(sample.acceleration.x(), acceleration_of(number));
      ASSERT_EQ(sample.acceleration.z(), acceleration_of(number));
      ASSERT_NEAR(yaw_of(sample.orientation), yaw_at(number), 1e-9);
      ++imu_taken;
      imu_until = sample.t_ns;
    }
    for (std::size_t i = buffer->wheel().count_until(wheel_until); i < buffer->wheel().size();
         ++i) {
      const EncoderSample& sample = buffer->wheel()[i];
      ASSERT_EQ(sample.raw, sample.t_ns / kStep);
      ASSERT_EQ(sample.distance, static_cast<double>(sample.raw));
      ++wheel_taken;
      wheel_until = sample.t_ns;
    }
    EXPECT_TRUE(buffer->imu().empty() || buffer->attitude_at(buffer->imu().newest().t_ns));
  }
  imu.join();
  wheel.join();
  EXPECT_EQ(imu_taken + imu_refused, kSamples);
  EXPECT_EQ(wheel_taken + wheel_refused, kSamples);
  EXPECT_EQ(static_cast<std::int64_t>(buffer->dropped()), imu_refused + wheel_refused);
  EXPECT_EQ(buffer->late(), 0U);
}

}  // namespace
}  // namespace scree
