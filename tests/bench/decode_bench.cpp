#include <benchmark/benchmark.h>

#include "scree/drivers/velodyne/data_packet.hpp"
#include "unit/velodyne/packet_builder.hpp"

namespace scree::velodyne {
namespace {

void decode_packet(benchmark::State& state, ReturnMode mode) {
  PacketBuilder packet;
  packet.mode(mode).product(Product::vlp16).turn(35900, 40);
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    packet.shot(shot, static_cast<std::uint16_t>(500 + 37 * shot),
                static_cast<std::uint8_t>(shot % 256));
  }
  const PacketDecoder decoder(LidarModel::vlp16);
  Shots shots;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(check_data_packet(packet.bytes(), LidarModel::vlp16));
    decoder.decode(packet.bytes(), shots);
    benchmark::DoNotOptimize(shots);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK_CAPTURE(decode_packet, strongest, ReturnMode::strongest);
BENCHMARK_CAPTURE(decode_packet, dual, ReturnMode::dual);

}  // namespace
}  // namespace scree::velodyne
