// Frames of a CAN bus down to the odometer and the ring buffer, with any place of the signal that
// the settings allow. Distances are finite.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "memory_file.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"
#include "scree/sync/sync_buffer.hpp"

namespace {

using namespace scree;

EncoderSettings settings_of(FuzzedDataProvider& input) {
  EncoderSettings settings;
  settings.length = input.ConsumeIntegralInRange(1, 64);
  settings.byte_order = input.ConsumeBool() ? ByteOrder::little_endian : ByteOrder::big_endian;
  const int last = 512 - settings.length;
  settings.start_bit = input.ConsumeIntegralInRange(0, std::min(last, 511));
  settings.is_signed = input.ConsumeBool();
  settings.kind = input.ConsumeBool() ? EncoderKind::counter : EncoderKind::speed;
  settings.scale = input.ConsumeFloatingPointInRange(-1.0, 1.0);
  settings.is_float = settings.length % 32 == 0 && input.ConsumeBool();
  settings.any_source = input.ConsumeBool();
  return settings;
}

CanFrame frame_of(FuzzedDataProvider& input, const EncoderSettings& settings, std::int64_t& t_ns) {
  CanFrame frame;
  t_ns += input.ConsumeIntegralInRange<std::int64_t>(-1'000'000, 50'000'000);
  frame.t_ns = t_ns;
  frame.id = static_cast<std::uint32_t>(settings.can_id);
  if (input.ConsumeIntegralInRange(0, 9) == 0) frame.id = input.ConsumeIntegral<std::uint32_t>();
  frame.is_extended = settings.has_extended_id() != (input.ConsumeIntegralInRange(0, 19) == 0);
  frame.is_error = input.ConsumeIntegralInRange(0, 19) == 0;
  frame.is_remote = input.ConsumeIntegralInRange(0, 19) == 0;
  frame.size = input.ConsumeIntegralInRange<std::uint8_t>(0, 64);
  input.ConsumeData(frame.data.data(), frame.size);
  return frame;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider input(bytes, size);
  const EncoderSettings settings = settings_of(input);
  if (settings.frame_bytes() > 64) return 0;
  const auto buffer = std::make_unique<SyncBuffer>();
  encoder::EncoderStream stream(settings, [&](const EncoderSample& sample) {
    fuzz::require(std::isfinite(sample.distance));
    buffer->put(sample);
    buffer->gather();
  });
  std::int64_t t_ns = 1'598'612'523'000'000'000;
  while (input.remaining_bytes() > 0) {
    stream.take(frame_of(input, settings, t_ns));
    buffer->wheel_at(t_ns - input.ConsumeIntegralInRange<std::int64_t>(0, 100'000'000));
  }
  return 0;
}
