// Compares the daemon's way, a thread for each sensor and one that detects, with a single thread.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "scree/app/pipeline.hpp"
#include "scree/capture/can_log.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "scree/publish/jsonl.hpp"
#include "spsc_pool.hpp"
#include "unit/recordings.hpp"

namespace scree {
namespace {

const std::string kCapture = "captures/interop";
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kSweeps = 20;  // of many times the work; memory and threads are used alike in each
#else
constexpr int kSweeps = 40;
#endif

Settings settings() {
  auto loaded = load_settings(shared(kCapture + "/scree.toml"));
  EXPECT_TRUE(loaded) << loaded.error().message;
  return *loaded;
}

Pipeline pipeline_of(const Settings& settings) {
  auto made = Pipeline::make(settings, std::string(SCREE_SOURCE) + "/config/scree.toml");
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

void play_imu(const Settings& settings, SyncBuffer& sensors) {
  xsens::ImuStream stream(settings.imu, [&](const ImuSample& sample) { sensors.put(sample); });
  auto file = PcapReader::open(shared(kCapture + "/imu.pcap"));
  ASSERT_TRUE(file) << file.error().message;
  for (PcapRecord record; file->next(record);) stream.take(record.bytes, record.arrival_ns);
}

void play_encoder(const Settings& settings, SyncBuffer& sensors) {
  encoder::EncoderStream stream(settings.encoder,
                                [&](const EncoderSample& sample) { sensors.put(sample); });
  auto file = CanLogReader::open(shared(kCapture + "/can.log"));
  ASSERT_TRUE(file) << file.error().message;
  for (CanFrame frame; file->next(frame);) stream.take(frame);
}

/// Until `on_sweep` returns false.
template <class OnSweep>
void play_lidar(const Settings& settings, OnSweep on_sweep) {
  bool goes_on = true;
  velodyne::LidarStream stream(settings.lidar,
                               [&](Sweep& sweep) { goes_on = goes_on && on_sweep(sweep); });
  auto file = PcapReader::open(shared(kCapture + "/lidar.pcap"));
  ASSERT_TRUE(file) << file.error().message;
  for (Datagram datagram; goes_on && file->next(datagram);) {
    if (datagram.destination_port == settings.lidar.port) {
      stream.take(datagram.payload, datagram.arrival_ns);
    }
  }
}

std::string line_of(const ObstacleList& list) {
  std::string line;
  append_json_line(list, line);
  return line;
}

std::vector<std::string> in_one_thread() {
  const Settings robot = settings();
  Pipeline pipeline = pipeline_of(robot);
  play_imu(robot, pipeline.sensors());
  play_encoder(robot, pipeline.sensors());
  std::vector<std::string> lines;
  play_lidar(robot, [&](const Sweep& sweep) {
    lines.push_back(line_of(pipeline.process(sweep)));
    return lines.size() < kSweeps;
  });
  return lines;
}

/// Nothing is late: samples are waited for as long as it takes.
bool has_come(Pipeline& pipeline, std::int64_t end_ns) {
  pipeline.sensors().gather();
  const auto reaches = [end_ns](const auto& history) {
    return !history.empty() && history.newest().t_ns >= end_ns;
  };
  return reaches(pipeline.sensors().imu()) && reaches(pipeline.sensors().wheel());
}

std::vector<std::string> in_a_thread_each() {
  const Settings robot = settings();
  Pipeline pipeline = pipeline_of(robot);
  SpscPool<Sweep> sweeps(3, [] { return Sweep(velodyne::kSweepCapacity); });
  const std::jthread imu([&] { play_imu(robot, pipeline.sensors()); });
  const std::jthread encoder([&] { play_encoder(robot, pipeline.sensors()); });
  const std::jthread lidar([&] {
    int pushed = 0;
    play_lidar(robot, [&](Sweep& sweep) {
      Sweep* item = nullptr;
      while ((item = sweeps.acquire()) == nullptr) std::this_thread::yield();
      std::swap(*item, sweep);
      sweeps.push(item);
      return ++pushed < kSweeps;
    });
  });
  std::vector<std::string> lines;
  while (lines.size() < kSweeps) {
    sweeps.wait(std::chrono::milliseconds(100));
    while (Sweep* sweep = sweeps.pop()) {
      while (!has_come(pipeline, sweep->end_ns)) std::this_thread::yield();
      lines.push_back(line_of(pipeline.process(*sweep)));
      sweeps.release(sweep);
    }
  }
  return lines;
}

TEST(LivePipeline, GivesTheSameListsAsOneThreadWhenNothingIsLate) {
  NEEDS(kCapture);
  const std::vector<std::string> alone = in_one_thread();
  const std::vector<std::string> live = in_a_thread_each();
  ASSERT_EQ(alone.size(), std::size_t{kSweeps});
  EXPECT_EQ(live, alone);
  EXPECT_NE(alone.back().find("\"kind\""), std::string::npos) << "no obstacle to compare";
}

}  // namespace
}  // namespace scree
