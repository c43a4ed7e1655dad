#include "simulator/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"
#include "simulator/robot.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// A short drive over a coarse terrain.
CaptureSettings quick() {
  CaptureSettings settings;
  settings.seconds = 0.4;
  settings.speed = 1.5;
  settings.cell = 0.08;
  settings.margin = 14;
  return settings;
}

TEST(Capture, HoldsWhatTheContractSays) {
  const TemporaryFolder folder;
  CaptureSettings settings = quick();
  settings.faults.packet_loss = 0;
  std::size_t last = 0;
  const auto written =
      write_capture(folder.path(), settings, [&](std::size_t done) { last = done; });
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(last, 1000U);

  const auto loaded = load_settings(folder / "scree.toml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  const Robot robot = draw_robot(settings.seed);
  EXPECT_TRUE(loaded->lidar.translation.isApprox(robot.lidar.translation, 1e-9));
  EXPECT_TRUE(loaded->imu.rpy_deg.isApprox(robot.imu.rpy_deg, 1e-9));
  EXPECT_EQ(loaded->encoder.can_id, robot.encoder.can_id);
  EXPECT_EQ(loaded->encoder.byte_order, robot.encoder.byte_order);
  EXPECT_EQ(loaded->encoder.scale, robot.encoder.scale);

  auto reader = PcapReader::open(folder / "lidar.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  const velodyne::PacketDecoder decoder(loaded->lidar.model);
  const auto shots = std::make_unique<velodyne::Shots>();
  int data = 0;
  int positions = 0;
  int returns = 0;
  std::int64_t arrival = 0;
  for (Datagram datagram; reader->next(datagram);) {
    EXPECT_GT(datagram.arrival_ns, arrival);
    arrival = datagram.arrival_ns;
    if (datagram.destination_port == 8308) {
      EXPECT_EQ(datagram.payload.size(), 512U);
      ++positions;
      continue;
    }
    ASSERT_EQ(velodyne::check_data_packet(datagram.payload, loaded->lidar.model),
              velodyne::Refusal::none);
    ++data;
    decoder.decode(datagram.payload, *shots);
    returns += static_cast<int>(
        std::count_if(shots->range.begin(), shots->range.end(), [](float r) { return r > 0; }));
  }
  EXPECT_GT(data, 220);  // 0.4 s of 1327.104 us each, less what is missing of the first turn
  EXPECT_LT(data, 305);
  EXPECT_GE(positions, data / 6);
  EXPECT_GT(returns, 20'000);
  EXPECT_GT(bytes_of(folder / "imu.pcap").size(), 40U * 70U);
  EXPECT_NE(bytes_of(folder / "can.log").find(fmt::format("{:03X}#", robot.encoder.can_id)),
            std::string::npos);
}

TEST(Capture, TruthKnowsPosesAndWhatIsVisible) {
  const TemporaryFolder folder;
  CaptureSettings settings = quick();
  settings.seconds = 1.5;
  settings.rate_hz = 5;
  ASSERT_TRUE(write_capture(folder.path(), settings, [](std::size_t) {}));
  const auto truth = nlohmann::json::parse(bytes_of(folder / "truth.json"));
  EXPECT_GE(truth["obstacles"].size(), 5U);
  ASSERT_EQ(truth["visible"].size(), 8U);
  const auto t_of = [](const nlohmann::json& entry) { return entry["t_ns"].get<std::int64_t>(); };
  const auto& poses = truth["poses"];
  for (std::size_t i = 1; i < poses.size(); ++i) {
    EXPECT_EQ(t_of(poses[i]) - t_of(poses[i - 1]), 10'000'000);
  }
  for (const auto& visible : truth["visible"]) {
    EXPECT_EQ(visible["ids"].size() + visible["ignore"].size(), truth["obstacles"].size());
    EXPECT_LE(t_of(poses.front()), t_of(visible));
    EXPECT_GE(t_of(poses.back()), t_of(visible));
  }
}

TEST(Capture, AtRestTheRobotStandsLevelAtTheOrigin) {
  const TemporaryFolder folder;
  CaptureSettings settings = quick();
  settings.at_rest = true;
  ASSERT_TRUE(write_capture(folder.path(), settings, [](std::size_t) {}));
  const auto truth = nlohmann::json::parse(bytes_of(folder / "truth.json"));
  EXPECT_EQ(truth["poses"].back()["q"], nlohmann::json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_EQ(truth["visible"].size(), 4U);
}

TEST(Capture, SameSeedSameBytes) {
  const TemporaryFolder a;
  const TemporaryFolder b;
  CaptureSettings settings = quick();
  settings.seconds = 0.1;
  settings.dual = true;
  settings.seed = 7;
  for (const TemporaryFolder* folder : {&a, &b}) {
    ASSERT_TRUE(write_capture(folder->path(), settings, [](std::size_t) {}));
  }
  for (const char* file : {"lidar.pcap", "imu.pcap", "can.log", "truth.json", "scree.toml"}) {
    EXPECT_EQ(bytes_of(a / file), bytes_of(b / file)) << file;
  }
}

/// Host times of the frames of an id in a can.log, in nanoseconds.
std::vector<std::int64_t> frames_of(const fs::path& file, std::int64_t can_id) {
  std::vector<std::int64_t> times;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::string id = fmt::format(" {:0{}X}#", can_id, can_id > 0x7FF ? 8 : 3);
    if (line.find(id) == std::string::npos) continue;
    times.push_back(std::stoll(line.substr(1, 10)) * 1'000'000'000 +
                    std::stoll(line.substr(12, 6)) * 1000);
  }
  return times;
}

TEST(Capture, GapsAreWhereTheyWereAskedFor) {
  const TemporaryFolder folder;
  CaptureSettings settings = quick();
  settings.seconds = 1;
  settings.faults.imu_gap = {0.2, 0.3};
  settings.faults.encoder_gap = {0.6, 0.25};
  ASSERT_TRUE(write_capture(folder.path(), settings, [](std::size_t) {}));
  const auto longest_pause = [](const std::vector<std::int64_t>& times, double start) {
    std::size_t longest = 1;
    for (std::size_t i = 2; i < times.size(); ++i) {
      if (times[i] - times[i - 1] > times[longest] - times[longest - 1]) longest = i;
    }
    constexpr std::int64_t kBegin = 1'598'612'520'000'000'000;
    EXPECT_NEAR(static_cast<double>(times[longest - 1] - kBegin) * 1e-9, start, 0.02);
    return static_cast<double>(times[longest] - times[longest - 1]) * 1e-9;
  };
  std::vector<std::int64_t> reads;
  auto reader = PcapReader::open(folder / "imu.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  for (PcapRecord record; reader->next(record);) reads.push_back(record.arrival_ns);
  EXPECT_NEAR(longest_pause(reads, 0.2), 0.3, 0.02);

  const Robot robot = draw_robot(settings.seed);
  const auto frames = frames_of(folder / "can.log", robot.encoder.can_id);
  EXPECT_NEAR(longest_pause(frames, 0.6), 0.25, 0.02);
}

TEST(Capture, UnwritableFolderIsOneSentence) {
  const auto written = write_capture("/proc/nowhere", {}, [](std::size_t) {});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, testing::HasSubstr("/proc/nowhere"));
}

TEST(Cloud, IsWrittenWithItsTruth) {
  const TemporaryFolder folder;
  CloudSettings settings;
  settings.points = 20'000;
  ASSERT_TRUE(write_cloud(folder / "c.pcd", settings, 3));
  const auto cloud = read_pcd(folder / "c.pcd");
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->size(), 20'000U);
  const auto truth = nlohmann::json::parse(bytes_of(folder / "c.truth.json"));
  EXPECT_EQ(truth["visible"][0]["ids"].size(), truth["obstacles"].size());
  EXPECT_EQ(truth["obstacles"].size(), 18U);
}

}  // namespace
}  // namespace scree
