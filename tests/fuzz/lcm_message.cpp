// What comes on LCM's multicast group: datagrams, whole messages and fragments, of any bytes.
#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <string_view>
#include <vector>

#include "memory_file.hpp"
#include "publish/lcm_datagrams.hpp"
#include "scree/publish/message_decoder.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/publisher.hpp"

namespace {

constexpr std::array<std::string_view, 3> kChannels = {scree::kObstaclesChannel,
                                                       scree::kHealthChannel, scree::kGridChannel};

void put_u32(std::vector<std::uint8_t>& to, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    to.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// With a head that passes, so that what stands behind it is looked at.
std::vector<std::uint8_t> datagram_of(FuzzedDataProvider& input) {
  std::vector<std::uint8_t> datagram;
  const bool is_short = input.ConsumeBool();
  const std::string_view channel = kChannels[input.ConsumeIntegralInRange<std::size_t>(0, 2)];
  put_u32(datagram, is_short ? 0x4c433032 : 0x4c433033);
  put_u32(datagram, input.ConsumeIntegralInRange<std::uint32_t>(0, 3));
  std::uint32_t number = 0;
  if (!is_short) {
    put_u32(datagram, input.ConsumeIntegral<std::uint32_t>());
    put_u32(datagram, input.ConsumeIntegral<std::uint32_t>());
    number = input.ConsumeIntegralInRange<std::uint32_t>(0, 3);
    put_u32(datagram, number << 16U | input.ConsumeIntegralInRange<std::uint32_t>(0, 4));
  }
  if (number == 0) {
    datagram.insert(datagram.end(), channel.begin(), channel.end());
    datagram.push_back(0);
  }
  const auto rest = input.ConsumeBytes<std::uint8_t>(input.ConsumeIntegralInRange<int>(0, 2000));
  datagram.insert(datagram.end(), rest.begin(), rest.end());
  return datagram;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider input(bytes, size);
  scree::LcmDatagrams datagrams;
  scree::ObstacleList list;
  scree::MessageDecoder decoder(
      [&](const scree::obstacle_list_t& message) { from_message(message, list); },
      [](const scree::health_t&) {}, [](const scree::grid_t&) {});
  while (input.remaining_bytes() > 0) {
    const auto datagram =
        input.ConsumeBool()
            ? datagram_of(input)
            : input.ConsumeBytes<std::uint8_t>(input.ConsumeIntegralInRange<int>(0, 2000));
    const auto message = datagrams.take(datagram, input.ConsumeIntegralInRange<int>(1, 2));
    if (message) decoder.take(message->channel, message->data);
  }
  return 0;
}
