#include "scree/app/pipeline.hpp"

#include <gtest/gtest.h>

#include <string>

#include "allocation_counter.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "velodyne/packet_builder.hpp"

namespace scree {
namespace {

Pipeline pipeline_of(const Settings& settings) {
  return {settings, Networks()};
}

Sweep sweep_of(std::initializer_list<Eigen::Vector3f> points) {
  Sweep sweep(points.size());
  for (const Eigen::Vector3f& point : points) sweep.push_back(point, 7, 0, 0);
  sweep.end_ns = 1'598'612'523'000'000'042;
  return sweep;
}

TEST(Pipeline, MovesASweepIntoBaseAndStampsTheList) {
  Settings settings;
  settings.lidar.translation = {0.1, 0, 0.95};
  settings.lidar.rpy_deg = {0, 0, 90};
  Pipeline pipeline = pipeline_of(settings);
  const ObstacleList& list = pipeline.process(sweep_of({{2, 0, -0.5F}}));
  EXPECT_EQ(list.stamp_ns, 1'598'612'523'000'000'042);
  EXPECT_EQ(list.pose.translation, Eigen::Vector3d::Zero());
  ASSERT_EQ(pipeline.ground().size(), 1U);
  EXPECT_NEAR(pipeline.ground().x[0], 0.1, 1e-6);
  EXPECT_NEAR(pipeline.ground().y[0], 2, 1e-6);
  EXPECT_NEAR(pipeline.ground().z[0], 0.45, 1e-6);
  EXPECT_EQ(pipeline.ground().reflectivity[0], 7);
}

TEST(Pipeline, LeavesOutWhatIsTooNearOrTooFar) {
  Settings settings;
  settings.lidar.min_range = 0.5;
  settings.lidar.max_range = 30;
  Pipeline pipeline = pipeline_of(settings);
  pipeline.process(sweep_of({{0.3F, 0.3F, 0}, {0.5F, 0, 0.1F}, {29.9F, 0, 0}, {29, 9, 0}}));
  EXPECT_EQ(pipeline.ground().size(), 2U);
}

TEST(Pipeline, CountsPointsBeyondItsMemory) {
  Settings settings;
  settings.memory.sweep_points = 2;
  Pipeline pipeline = pipeline_of(settings);
  pipeline.process(sweep_of({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}));
  EXPECT_EQ(pipeline.counts().input, 4U);
  EXPECT_EQ(pipeline.counts().dropped, 2U);
}

TEST(Pipeline, TheNetworkOfTracksMayBeLeftOutButNotMissing) {
  const std::string config_file = std::string(SCREE_SOURCE) + "/config/scree.toml";
  Settings settings;
  settings.track.network = "nowhere.txt";
  const auto made = Pipeline::make(settings, config_file);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("nowhere.txt"), std::string::npos) << made.error().message;
  settings.track.network.clear();
  EXPECT_TRUE(Pipeline::make(settings, config_file));
}

TEST(Pipeline, ANetworkThatAsksForMoreFeaturesThanTheMethodHasIsRefused) {
  const std::string config_file = std::string(SCREE_SOURCE) + "/config/scree.toml";
  Settings settings;
  settings.detect_map.method = Method::edges;
  const auto made = Pipeline::make(settings, config_file);
  ASSERT_FALSE(made);
  EXPECT_EQ(
      made.error().message,
      "detect.map.network: network_map.txt takes 33 features, and detect.map.method = \"edges\" "
      "has 5: name a network that was trained with it");
  settings.detect_map.network = "network_paper.txt";
  EXPECT_TRUE(Pipeline::make(settings, config_file));
}

TEST(Pipeline, NothingIsAllocatedFromPacketToListAfterTheStart) {
  const Settings settings;
  Pipeline pipeline = pipeline_of(settings);
  std::size_t lists = 0;
  velodyne::LidarStream stream(settings.lidar, [&](Sweep& sweep) {
    pipeline.process(sweep);
    ++lists;
  });
  velodyne::PacketBuilder packet;
  packet.all_shots(1250, 30);
  std::int64_t elapsed_ns = 0;
  const auto turn = [&] {
    const std::size_t before = lists;
    while (lists == before) {
      const std::int64_t duration = velodyne::packet_duration_ns(velodyne::ReturnMode::strongest);
      packet.turn(static_cast<int>(elapsed_ns / 1000 * 36 / 100 % 36000), 40);
      packet.timestamp(static_cast<std::uint32_t>(elapsed_ns / 1000));
      elapsed_ns += duration;
      stream.take(packet.bytes(), 1'598'612'523'000'000'000 + elapsed_ns);
    }
  };
  turn();
  turn();
  const std::size_t before = test::allocations();
  for (int i = 0; i < 5; ++i) turn();
  EXPECT_EQ(test::allocations(), before);
  EXPECT_GT(pipeline.counts().voxels, 1000U);
  EXPECT_EQ(stream.counters().all_refused(), 0U);
}

}  // namespace
}  // namespace scree
