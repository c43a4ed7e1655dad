// An IMU's bytes down to the ring buffer: messages with right checksums, whose values are any, and
// bytes that are none. The buffer's samples are in order and finite.
#include <fuzzer/FuzzedDataProvider.h>

#include <memory>
#include <vector>

#include "memory_file.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace {

using namespace scree;

constexpr std::uint16_t kItems[] = {0x1020, 0x1060, 0x1070, 0x2010, 0x2012, 0x2020, 0x2030, 0x2034,
                                    0x4010, 0x4020, 0x4040, 0x8020, 0x8030, 0xC020, 0xE010, 0xE020};

/// MTData2 of items with the sizes that they have, or any.
std::vector<std::uint8_t> message_of(FuzzedDataProvider& input, std::uint16_t& counter,
                                     std::uint32_t& tick) {
  std::vector<std::uint8_t> data = {0x10,
                                    0x20,
                                    2,
                                    std::uint8_t(counter >> 8U),
                                    std::uint8_t(counter),
                                    0x10,
                                    0x60,
                                    4,
                                    std::uint8_t(tick >> 24U),
                                    std::uint8_t(tick >> 16U),
                                    std::uint8_t(tick >> 8U),
                                    std::uint8_t(tick)};
  counter = static_cast<std::uint16_t>(counter + input.ConsumeIntegralInRange(0, 3));
  tick += input.ConsumeIntegralInRange<std::uint32_t>(0, 300);
  for (int i = input.ConsumeIntegralInRange(0, 4); i > 0; --i) {
    const std::uint16_t id = input.PickValueInArray(kItems);
    const auto value = input.ConsumeBytes<std::uint8_t>(input.ConsumeIntegralInRange(0, 36));
    data.push_back(static_cast<std::uint8_t>(id >> 8U));
    data.push_back(static_cast<std::uint8_t>(id));
    data.push_back(static_cast<std::uint8_t>(value.size()));
    data.insert(data.end(), value.begin(), value.end());
  }
  std::vector<std::uint8_t> message = {0xFA, 0xFF, 0x36, static_cast<std::uint8_t>(data.size())};
  message.insert(message.end(), data.begin(), data.end());
  std::uint8_t sum = 0;
  for (std::size_t i = 1; i < message.size(); ++i)
    sum = static_cast<std::uint8_t>(sum + message[i]);
  message.push_back(static_cast<std::uint8_t>(-sum));
  return message;
}

void check(const SyncBuffer& buffer) {
  std::int64_t last_ns = INT64_MIN;
  for (std::size_t i = 0; i < buffer.imu().size(); ++i) {
    const ImuSample& sample = buffer.imu()[i];
    fuzz::require(sample.t_ns > last_ns && sample.orientation.coeffs().allFinite());
    last_ns = sample.t_ns;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider input(bytes, size);
  const auto buffer = std::make_unique<SyncBuffer>();
  xsens::ImuStream stream(ImuSettings(), [&](const ImuSample& sample) {
    buffer->put(sample);
    buffer->gather();
  });
  std::int64_t arrival_ns = 1'598'612'523'000'000'000;
  std::uint16_t counter = 65'000;
  std::uint32_t tick = 0xFFFFF000;
  while (input.remaining_bytes() > 0) {
    arrival_ns += input.ConsumeIntegralInRange<std::int64_t>(0, 30'000'000);
    if (input.ConsumeIntegralInRange(0, 9) == 0) {
      stream.take(input.ConsumeBytes<std::uint8_t>(input.ConsumeIntegralInRange(0, 80)),
                  arrival_ns);
    } else {
      stream.take(message_of(input, counter, tick), arrival_ns);
    }
    buffer->attitude_at(arrival_ns - input.ConsumeIntegralInRange<std::int64_t>(0, 100'000'000));
  }
  stream.flush();
  check(*buffer);
  return 0;
}
