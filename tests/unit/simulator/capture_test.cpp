#include "simulator/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcd.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/data_packet.hpp"

namespace scree {
namespace {

namespace fs = std::filesystem;

class Folder {
public:
  explicit Folder(const std::string& name) : path(fs::path(testing::TempDir()) / name) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path path;
};

std::string bytes_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST(Capture, HoldsWhatTheContractSays) {
  const Folder folder("scree_capture_test");
  CaptureSettings settings;
  settings.seconds = 0.4;
  std::size_t last = 0;
  const auto written = write_capture(folder.path, settings, [&](std::size_t done) { last = done; });
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(last, 1000U);

  const auto loaded = load_settings(folder.path / "scree.toml");
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->lidar.translation, Eigen::Vector3d(0.1, 0, 0.95));

  auto reader = PcapReader::open(folder.path / "lidar.pcap");
  ASSERT_TRUE(reader) << reader.error().message;
  const velodyne::PacketDecoder decoder(loaded->lidar.model);
  const auto shots = std::make_unique<velodyne::Shots>();
  const Pose mount = loaded->lidar.mount();
  int data = 0;
  int positions = 0;
  int near_ground = 0;
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
    for (std::size_t i = 0; i < velodyne::kShots; ++i) {
      if (shots->range[i] <= 0 || shots->range[i] > 3.5F) continue;
      const Eigen::Vector3f seen(shots->x[i], shots->y[i], shots->z[i]);
      near_ground += std::abs((mount * seen.cast<double>()).z()) < 0.3 ? 1 : 0;
    }
  }
  EXPECT_EQ(data, 302);  // 0.4 s of 1327.104 us each, and the one that begins the next turn
  EXPECT_GT(positions, data / 6);
  EXPECT_GT(near_ground, 500);

  const auto truth = nlohmann::json::parse(bytes_of(folder.path / "truth.json"));
  EXPECT_GE(truth["obstacles"].size(), 12U);
  ASSERT_EQ(truth["visible"].size(), 4U);
  const auto& visible = truth["visible"].back();
  EXPECT_EQ(visible["ids"].size() + visible["ignore"].size(), truth["obstacles"].size());
  EXPECT_GT(visible["ids"].size(), 2U);
  EXPECT_EQ(truth["poses"].front()["q"], nlohmann::json({1.0, 0.0, 0.0, 0.0}));
  EXPECT_GE(truth["poses"].back()["t_ns"].get<std::int64_t>(), visible["t_ns"].get<std::int64_t>());
}

TEST(Capture, SameSeedSameBytes) {
  const Folder a("scree_capture_a");
  const Folder b("scree_capture_b");
  CaptureSettings settings;
  settings.seconds = 0.1;
  settings.dual = true;
  settings.seed = 7;
  for (const Folder* folder : {&a, &b}) {
    ASSERT_TRUE(write_capture(folder->path, settings, [](std::size_t) {}));
  }
  for (const char* file : {"lidar.pcap", "truth.json", "scree.toml"}) {
    EXPECT_EQ(bytes_of(a.path / file), bytes_of(b.path / file)) << file;
  }
}

TEST(Capture, UnwritableFolderIsOneSentence) {
  const auto written = write_capture("/proc/nowhere", {}, [](std::size_t) {});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, testing::HasSubstr("/proc/nowhere"));
}

TEST(Cloud, IsWrittenWithItsTruth) {
  const Folder folder("scree_cloud_test");
  CloudSettings settings;
  settings.points = 20'000;
  ASSERT_TRUE(write_cloud(folder.path / "c.pcd", settings, 3));
  const auto cloud = read_pcd(folder.path / "c.pcd");
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->size(), 20'000U);
  const auto truth = nlohmann::json::parse(bytes_of(folder.path / "c.truth.json"));
  EXPECT_EQ(truth["visible"][0]["ids"].size(), truth["obstacles"].size());
  EXPECT_EQ(truth["obstacles"].size(), 18U);
}

}  // namespace
}  // namespace scree
