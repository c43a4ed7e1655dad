// What the simulator writes, the driver reads.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "scree/capture/pcap_reader.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "simulator/imu.hpp"
#include "simulator/links.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

Motion wavy_drive() {
  std::vector<Pose> knots;
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.0025 * i;
    knots.push_back({{t, 0.3 * std::sin(t), 0.02 * std::sin(3 * t)},
                     from_roll_pitch_yaw(0.1 * std::sin(t), 0.05 * std::cos(2 * t), 0.3 * t)});
  }
  return {std::move(knots), 0, 2'500'000};
}

struct Ride {
  std::vector<ImuMessage> sent;
  std::vector<ImuSample> read;
  xsens::ImuCounters counters;
};

Ride drive(double rate_hz, int baud, std::int64_t burst_ns) {
  Ride drive;
  const TemporaryFolder folder;
  const Motion motion = wavy_drive();
  SimulatedImuSettings simulated;
  simulated.rate_hz = rate_hz;
  simulated.clock_skew = 40e-6;
  SimulatedImu imu(motion, Pose(), simulated, 1'000'000'000, 4);
  {
    auto file = PcapWriter::create_serial(folder / "imu.pcap");
    EXPECT_TRUE(file) << file.error().message;
    SerialPort port(*file, baud, burst_ns, 5);
    for (int i = 0; i < 15 * static_cast<int>(rate_hz); ++i) {
      drive.sent.push_back(imu.next());
      port.send(drive.sent.back().t_ns, mt_data2(drive.sent.back()));
    }
    port.finish();
    EXPECT_TRUE(file->close());
  }
  ImuSettings settings;
  settings.baud = baud;
  xsens::ImuStream stream(settings, [&](const ImuSample& sample) { drive.read.push_back(sample); });
  auto reader = PcapReader::open(folder / "imu.pcap");
  EXPECT_TRUE(reader) << reader.error().message;
  PcapRecord record;
  while (reader->next(record)) stream.take(record.bytes, record.arrival_ns);
  stream.flush();
  drive.counters = stream.counters();
  return drive;
}

void expect_float(const Eigen::Vector3d& read, const Eigen::Vector3d& sent) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(static_cast<float>(read[i]), static_cast<float>(sent[i]));
}

TEST(ImuRoundTrip, EverySampleComesBack) {
  struct Case {
    double rate_hz;
    int baud;
    std::int64_t burst_ns, tolerance_ns;
  };
  for (const Case& c : {Case{100, 921600, 0, 600'000}, Case{400, 921600, 16'000'000, 1'000'000},
                        Case{100, 115200, 0, 600'000}}) {
    SCOPED_TRACE(c.rate_hz);
    const Ride result = drive(c.rate_hz, c.baud, c.burst_ns);
    ASSERT_EQ(result.read.size(), result.sent.size());
    EXPECT_EQ(result.counters.all_refused(), 0U);
    EXPECT_EQ(result.counters.bytes_skipped, 0U);
    EXPECT_EQ(result.counters.lost, 0U);
    EXPECT_EQ(result.counters.device_restarts + result.counters.host_steps, 0U);
    for (std::size_t i = 0; i < result.sent.size(); ++i) {
      const ImuMessage& sent = result.sent[i];
      const ImuSample& read = result.read[i];
      ASSERT_TRUE(read.has_orientation && read.has_rate && read.has_acceleration);
      expect_float(read.rate, sent.rate_of_turn);
      expect_float(read.acceleration, sent.acceleration);
      ASSERT_LT(read.orientation.angularDistance(sent.orientation), 1e-6);
      if (read.t_ns < 3'000'000'000) continue;
      ASSERT_LT(std::abs(read.t_ns - sent.t_ns), c.tolerance_ns) << i;
    }
  }
}

}  // namespace
}  // namespace scree
