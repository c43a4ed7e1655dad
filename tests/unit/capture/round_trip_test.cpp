// What is written reads back the same, whatever it is.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scree/capture/can_log.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcap_writer.hpp"
#include "scree/capture/pcd.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

/// As long as a pcap file's seconds last, which libpcap reads as 31 bits: until 2038.
rc::Gen<std::int64_t> any_time_us() {
  return rc::gen::inRange<std::int64_t>(0, 2'147'000'000'000'000);
}

CanFrame any_frame() {
  CanFrame frame;
  frame.t_ns = *any_time_us() * 1000;
  frame.is_extended = *rc::gen::arbitrary<bool>();
  frame.id = *rc::gen::inRange<std::uint32_t>(
      0, (frame.is_extended ? kLargestExtendedId : kLargestStandardId) + 1);
  frame.is_remote = *rc::gen::arbitrary<bool>();
  const int sizes = frame.is_remote ? 9 : 10;
  constexpr std::uint8_t kSizes[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 64};
  frame.size = kSizes[*rc::gen::inRange(0, sizes)];
  if (!frame.is_remote) {
    std::generate_n(frame.data.begin(), frame.size,
                    [] { return *rc::gen::arbitrary<std::uint8_t>(); });
  }
  return frame;
}

TEST(RoundTrip, FramesOfABusAreInTheLogAsTheyCame) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rc::check([&] {
    const CanFrame frame = any_frame();
    auto log = CanLogWriter::create(folder / "can.log");
    log->write(frame, "can0");
    RC_ASSERT(log->close().has_value());
    auto reader = CanLogReader::open(folder / "can.log");
    CanFrame read;
    std::string interface;
    RC_ASSERT(reader->next(read, &interface));
    RC_ASSERT(interface == "can0");
    RC_ASSERT(read.t_ns == frame.t_ns);
    RC_ASSERT(read.id == frame.id);
    RC_ASSERT(read.is_extended == frame.is_extended);
    RC_ASSERT(read.is_remote == frame.is_remote);
    RC_ASSERT(read.size == frame.size);
    RC_ASSERT(std::ranges::equal(read.payload(), frame.payload()));
  }));
}

TEST(RoundTrip, DatagramsAreInTheCaptureAsTheyCame) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rc::check([&] {
    const auto payload = *rc::gen::arbitrary<std::vector<std::uint8_t>>();
    Datagram datagram;
    datagram.arrival_ns = *any_time_us() * 1000 + *rc::gen::inRange<std::int64_t>(0, 1000);
    datagram.source = *rc::gen::arbitrary<std::uint32_t>();
    datagram.source_port = *rc::gen::arbitrary<std::uint16_t>();
    datagram.destination_port = *rc::gen::arbitrary<std::uint16_t>();
    datagram.payload = payload;
    auto writer = PcapWriter::create_ethernet(folder / "lidar.pcap");
    writer->write(datagram);
    RC_ASSERT(writer->close().has_value());
    auto reader = PcapReader::open(folder / "lidar.pcap");
    Datagram read;
    RC_ASSERT(reader->next(read));
    RC_ASSERT(read.arrival_ns == datagram.arrival_ns);
    RC_ASSERT(read.source == datagram.source);
    RC_ASSERT(read.source_port == datagram.source_port);
    RC_ASSERT(read.destination_port == datagram.destination_port);
    RC_ASSERT(std::ranges::equal(read.payload, payload));
  }));
}

TEST(RoundTrip, CloudsAreInTheFileAsTheyWere) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rc::check([&] {
    const auto values = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-20'000, 20'001));
    PointCloud cloud(values.size() / 4);
    const auto number = [&](std::size_t i) { return static_cast<float>(values[i]) / 64; };
    for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
      cloud.push_back(number(i), number(i + 1), number(i + 2), number(i + 3));
    }
    RC_PRE(cloud.size() > 0);
    RC_ASSERT(write_pcd(folder / "cloud.pcd", cloud).has_value());
    const auto read = read_pcd(folder / "cloud.pcd");
    RC_ASSERT(read.has_value());
    RC_ASSERT(read->x.size() == cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f at(read->x[i], read->y[i], read->z[i]);
      const Eigen::Vector3d in_file = at.cast<double>() + read->origin;
      RC_ASSERT(in_file == Eigen::Vector3f(cloud.x[i], cloud.y[i], cloud.z[i]).cast<double>());
      RC_ASSERT(read->reflectivity[i] == cloud.reflectivity[i]);
    }
  }));
}

}  // namespace
}  // namespace scree
