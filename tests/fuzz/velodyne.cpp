// A lidar's stream: packets that pass the first look, with whatever azimuths, stamps and times of
// arrival, lost, doubled and in disorder, and now and then other bytes. A sweep's times never fall.
#include <fuzzer/FuzzedDataProvider.h>

#include "memory_file.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "unit/velodyne/packet_builder.hpp"

namespace {

using namespace scree;
using namespace scree::velodyne;

void see(const Sweep& sweep) {
  for (std::size_t i = 1; i < sweep.time_ns.size(); ++i) {
    fuzz::require(sweep.time_ns[i] >= sweep.time_ns[i - 1]);
  }
  fuzz::require(sweep.time_ns.empty() || sweep.time_ns.back() <= 0);
}

struct Lidar {
  std::int64_t stamp_us = 100'000'000, arrival_ns = 1'598'612'523'000'000'000;
  int azimuth = 0, step = 20;

  PacketBuilder next(FuzzedDataProvider& input) {
    PacketBuilder packet;
    const bool is_dual = input.ConsumeIntegralInRange(0, 9) == 0;
    packet.mode(is_dual ? ReturnMode::dual : ReturnMode::strongest);
    if (input.ConsumeIntegralInRange(0, 19) == 0) packet.product(Product::hdl32e);
    if (input.ConsumeIntegralInRange(0, 9) == 0) {
      stamp_us = input.ConsumeIntegralInRange<std::int64_t>(0, 3'601'000'000);
      step = input.ConsumeIntegralInRange(0, 36'000);
    }
    if (input.ConsumeIntegralInRange(0, 9) == 0) {
      arrival_ns += input.ConsumeIntegralInRange<std::int64_t>(-4'000'000'000, 4'000'000'000);
    }
    packet.timestamp(static_cast<std::uint32_t>(stamp_us)).turn(azimuth, step);
    packet.all_shots(input.ConsumeIntegral<std::uint16_t>(), 7);
    for (int i = input.ConsumeIntegralInRange(0, 4); i > 0; --i) {
      packet.bytes()[input.ConsumeIntegralInRange<std::size_t>(0, kDataPacketSize - 1)] =
          input.ConsumeIntegral<std::uint8_t>();
    }
    const std::int64_t duration_ns = packet_duration_ns(ReturnMode::strongest);
    stamp_us = (stamp_us + duration_ns / 1000) % kHourUs;
    arrival_ns += duration_ns;
    azimuth = (azimuth + 12 * step) % kFullTurn;
    return packet;
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider input(bytes, size);
  LidarSettings settings;
  settings.model = static_cast<LidarModel>(input.ConsumeIntegralInRange(0, 2));
  settings.cut_azimuth_deg = input.ConsumeFloatingPointInRange(0.0, 359.0);
  static const auto stream_of = [](const LidarSettings& of) {
    return std::make_unique<LidarStream>(of, [](Sweep& sweep) { see(sweep); });
  };
  const auto stream = stream_of(settings);
  Lidar lidar;
  while (input.remaining_bytes() > 0) {
    switch (input.ConsumeIntegralInRange(0, 9)) {
      case 0:
        stream->take(input.ConsumeBytes<std::uint8_t>(kDataPacketSize), lidar.arrival_ns);
        break;
      case 1:
        for (int i = 0; i < 60; ++i) {
          PacketBuilder packet;
          packet.timestamp(static_cast<std::uint32_t>(lidar.stamp_us))
              .turn(lidar.azimuth, lidar.step);
          packet.all_shots(2500, 40);
          stream->take(packet.bytes(), lidar.arrival_ns);
          lidar.stamp_us = (lidar.stamp_us + 1327) % kHourUs;
          lidar.arrival_ns += kPacketNs;
          lidar.azimuth = (lidar.azimuth + 12 * lidar.step) % kFullTurn;
        }
        break;
      default:
        stream->take(lidar.next(input).bytes(), lidar.arrival_ns);
    }
  }
  stream->flush();
  return 0;
}
