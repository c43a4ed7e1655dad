// Real recordings (and one made by another simulator), kept outside the project.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>
#include <vector>

#include "scree/capture/pcap_reader.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "unit/recordings.hpp"
#include "unit/temporary_folder.hpp"

namespace scree::velodyne {
namespace {

struct Return {
  std::uint64_t packet;
  std::size_t laser;
  float range, reflectivity, azimuth, x, y, z;
};

struct Played {
  std::vector<Return> returns;
  std::vector<std::int64_t> sweep_ends_ns;
  std::vector<std::size_t> sweep_points;
  LidarCounters counters;
  Firmware firmware;
};

Played play(const char* name) {
  Played played;
  auto reader = PcapReader::open(shared(name));
  EXPECT_TRUE(reader) << reader.error().message;
  const auto on_sweep = [&](Sweep& sweep) {
    played.sweep_ends_ns.push_back(sweep.end_ns);
    played.sweep_points.push_back(sweep.points.size());
  };
  const auto on_packet = [&](const DecodedPacket& packet) {
    const Shots& shots = packet.shots;
    for (std::size_t i = 0; i < kShots; ++i) {
      if (shots.range[i] == 0) continue;
      played.returns.push_back({packet.index, laser_of(i), shots.range[i], shots.reflectivity[i],
                                shots.azimuth[i], shots.x[i], shots.y[i], shots.z[i]});
    }
  };
  const auto stream = std::make_unique<LidarStream>(LidarSettings{}, on_sweep, on_packet);
  Datagram datagram;
  while (reader->next(datagram)) {
    if (datagram.destination_port == 2368) stream->take(datagram.payload, datagram.arrival_ns);
  }
  stream->flush();
  played.counters = stream->counters();
  played.firmware = stream->firmware();
  return played;
}

TEST(Recordings, EarlyFirmwareIsAcceptedWhole) {
  NEEDS("vlp16/indoor_20hz.pcap");
  const Played played = play("vlp16/indoor_20hz.pcap");
  EXPECT_EQ(played.counters.accepted, 1902U);
  EXPECT_EQ(played.counters.all_refused(), 0U);
  EXPECT_EQ(played.counters.lost, 0U);
  EXPECT_EQ(played.firmware, Firmware::early_vlp16);
  EXPECT_EQ(played.sweep_ends_ns.size(), 52U);
}

TEST(Recordings, AnotherSensorIsRefusedWhole) {
  NEEDS("vlp16/not_a_vlp16.pcap");
  const Played played = play("vlp16/not_a_vlp16.pcap");
  EXPECT_EQ(played.counters.accepted, 0U);
  EXPECT_EQ(played.counters.refused[static_cast<std::size_t>(Refusal::timing)], 91U);
  EXPECT_EQ(played.firmware, Firmware::hdl32e);
  EXPECT_TRUE(played.sweep_ends_ns.empty());
}

TEST(Recordings, TenHertzGivesTenSweepsASecond) {
  NEEDS("vlp16/indoor_10hz.pcap");
  const Played played = play("vlp16/indoor_10hz.pcap");
  EXPECT_EQ(played.counters.accepted, 1000U);
  for (std::size_t i = 2; i + 1 < played.sweep_ends_ns.size(); ++i) {
    const auto turn_ns = static_cast<double>(played.sweep_ends_ns[i] - played.sweep_ends_ns[i - 1]);
    EXPECT_NEAR(turn_ns, 1e8, 1e6);
  }
}

TEST(Recordings, FirstPointOfFrame16IsVeloViews) {
  NEEDS("vlp16/indoor_20hz.pcap");
  // In the sensor's own axes: x right, y forward, z up without the vertical correction.
  constexpr double kX = 0.0801272, kY = 6.04037, kZ = -1.61865;
  const Played played = play("vlp16/indoor_20hz.pcap");
  // The frames are those of the file it was cut from; what can be found again is the point: one of
  // laser 0, which is the first to look past azimuth 0.
  double nearest = 1;
  for (const Return& r : played.returns) {
    if (r.laser != 0) continue;
    const double z = static_cast<double>(r.z) - 0.0112;
    nearest = std::min(
        nearest, std::hypot(-static_cast<double>(r.y) - kX, static_cast<double>(r.x) - kY, z - kZ));
  }
  EXPECT_LT(nearest, 2e-5);
}

TEST(Recordings, DualReturnsAreAnotherDecoders) {
  NEEDS("vlp16/indoor_dual_return.pcap");
  NEEDS("vlp16/indoor_dual_return_last_revolution.pcd");
  const Played played = play("vlp16/indoor_dual_return.pcap");
  EXPECT_EQ(played.counters.accepted, 603U);
  EXPECT_EQ(played.counters.by_mode[2], 603U);

  // What the wire has of the last revolution, as (laser, counts of 2 mm, reflectivity).
  using Triple = std::tuple<int, int, int>;
  std::map<Triple, int> have;
  for (const Return& r : played.returns) {
    if (r.packet < 450) continue;
    ++have[{static_cast<int>(r.laser), static_cast<int>(std::lround(r.range * 500)),
            static_cast<int>(r.reflectivity)}];
  }
  // Its lines are 32 bytes: x y z (float) intensity return_type (byte) channel (16 bit) azimuth
  // elevation distance (float) time (32 bit). Its channel counts lasers from the lowest upwards.
  const std::string pcd = bytes_of(shared("vlp16/indoor_dual_return_last_revolution.pcd"));
  const std::size_t body = pcd.find("DATA binary\n") + 12;
  constexpr std::size_t kLine = 32, kPoints = 14831;
  ASSERT_GE(pcd.size(), body + kLine * kPoints);
  int missing = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const char* const line = pcd.data() + body + kLine * i;
    std::uint16_t channel = 0;
    float distance = 0;
    std::memcpy(&channel, line + 14, 2);
    std::memcpy(&distance, line + 24, 4);
    const int laser = channel < 8 ? 2 * channel : 2 * (channel - 8) + 1;
    const int reflectivity = static_cast<unsigned char>(line[12]);
    if (--have[{laser, static_cast<int>(std::lround(distance * 500)), reflectivity}] < 0) ++missing;
  }
  EXPECT_EQ(missing, 0);
}

TEST(Recordings, SweepsEndWhenAnotherSimulatorsEnd) {
  NEEDS("captures/interop/lidar.pcap");
  NEEDS("captures/interop/truth.json");
  const Played played = play("captures/interop/lidar.pcap");
  const auto truth = nlohmann::json::parse(std::ifstream(shared("captures/interop/truth.json")));
  const auto& visible = truth["visible"];
  ASSERT_EQ(played.sweep_ends_ns.size(), visible.size());
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const auto expected = visible[i]["t_ns"].get<std::int64_t>();
    // The least delay of a packet cannot be told from a difference of the clocks; it is 0.1 ms
    // here.
    EXPECT_NEAR(static_cast<double>(played.sweep_ends_ns[i] - expected), 1e5, 1.5e5) << i;
  }
}

}  // namespace
}  // namespace scree::velodyne
