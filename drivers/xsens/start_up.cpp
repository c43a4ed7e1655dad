#include "scree/drivers/xsens/start_up.hpp"

#include <limits>
#include <utility>

#include "scree/core/nanoseconds.hpp"

namespace scree::xsens {
namespace {

struct BaudCode {
  int baud;
  std::uint8_t code;
};
/// The codes of SetBaudrate (MT0101P), the most usual bit rates first.
constexpr std::array<BaudCode, 13> kBaudCodes = {{{115200, 0x02},
                                                  {921600, 0x0A},
                                                  {460800, 0x00},
                                                  {230400, 0x01},
                                                  {2000000, 0x0C},
                                                  {57600, 0x04},
                                                  {38400, 0x05},
                                                  {19200, 0x07},
                                                  {9600, 0x09},
                                                  {3500000, 0x0E},
                                                  {4000000, 0x0D},
                                                  {4800, 0x0B},
                                                  {76800, 0x03}}};

std::optional<std::uint8_t> code_of(int baud) {
  for (const BaudCode& known : kBaudCodes) {
    if (known.baud == baud) return known.code;
  }
  return std::nullopt;
}

/// What an error code says (MT0101P, section "Error codes").
const char* meaning_of(int code) {
  switch (code) {
    case 3:
      return "the period is invalid";
    case 4:
      return "it does not know the message";
    case 30:
      return "its timer overflows";
    case 32:
      return "the bit rate is invalid";
    case 33:
      return "a parameter is invalid";
    case 40:
      return "the device has failed";
    case 41:
      return "that is more data than the line can carry";
    default:
      return "unknown reason";
  }
}

/// An entry of SetOutputConfiguration.
struct Output {
  DataId id;
  int hertz;
};
constexpr int kWithEveryMessage = 0xFFFF;
constexpr std::size_t kMostOutputs = 8, kOutputSize = 4;

/// @return how many there are
std::size_t outputs_of(const ImuSettings& settings, std::array<Output, kMostOutputs>& outputs) {
  outputs = {{{DataId::packet_counter, kWithEveryMessage},
              {DataId::sample_time_fine, kWithEveryMessage},
              {DataId::quaternion, settings.rate},
              {DataId::acceleration, settings.rate},
              {DataId::rate_of_turn, settings.rate},
              {DataId::status_word, kWithEveryMessage}}};
  std::size_t count = 6;
  if (settings.acceleration_hr_rate > 0) {
    outputs[count++] = {DataId::acceleration_hr, settings.acceleration_hr_rate};
  }
  if (settings.gyro_hr_rate > 0) {
    outputs[count++] = {DataId::rate_of_turn_hr, settings.gyro_hr_rate};
  }
  return count;
}

}  // namespace

std::optional<std::string> line_too_slow(const ImuSettings& settings) {
  // Every item has a header of three bytes, every message five bytes around its items.
  constexpr int kCommon = 5 + (3 + 2) + (3 + 4) + (3 + 4);
  constexpr int kSample = kCommon + (3 + 16) + 2 * (3 + 12), kHighRate = kCommon + (3 + 12);
  const int bytes =
      kSample * settings.rate + kHighRate * (settings.acceleration_hr_rate + settings.gyro_hr_rate);
  if (!settings.configure || bytes * 10 <= settings.baud) return std::nullopt;
  return "the outputs of imu.rate, imu.acceleration_hr_rate and imu.gyro_hr_rate need " +
         std::to_string(bytes * 10) +
         " bit/s, more than imu.baud = " + std::to_string(settings.baud);
}

const StartUp::Request& StartUp::request_of(Step step) {
  // A device writes its settings to memory before it acknowledges, which may take most of a second.
  static constexpr std::array<Request, 7> kRequests = {{
      {MessageId::go_to_config, "GoToConfig", 300 * kMillisecond, 2},
      {MessageId::request_device_id, "ReqDID", 500 * kMillisecond, 3},
      {MessageId::set_baud_rate, "SetBaudrate", 1500 * kMillisecond, 3},
      {MessageId::reset, "Reset", 500 * kMillisecond, 1},
      {MessageId::go_to_config, "GoToConfig", 300 * kMillisecond, 20},
      {MessageId::set_output_configuration, "SetOutputConfiguration", 1500 * kMillisecond, 3},
      {MessageId::go_to_measurement, "GoToMeasurement", 500 * kMillisecond, 3},
  }};
  return kRequests[static_cast<std::size_t>(step)];
}

StartUp::StartUp(const ImuSettings& settings) : settings_(settings), baud_(settings.baud) {}

void StartUp::begin(std::int64_t now_ns) {
  problem_.clear();
  note_.clear();
  framer_ = Framer();
  baud_ = settings_.baud;
  next_rate_ = 0;
  output_size_ = 0;
  if (!settings_.configure) {
    state_ = State::measuring;
    due_ns_ = std::numeric_limits<std::int64_t>::max();
    return;
  }
  state_ = State::working;
  enter(Step::find, now_ns);
}

void StartUp::take(Bytes bytes, std::int64_t now_ns) {
  framer_.take(bytes, [&](const Message& message) {
    if (state_ == State::working) take_message(message, now_ns);
  });
}

void StartUp::advance(std::int64_t now_ns) {
  if (state_ == State::working && now_ns >= due_ns_) try_step(now_ns);
}

Bytes StartUp::take_output() {
  return Bytes(output_).first(std::exchange(output_size_, 0));
}

/// What finds no room is as good as lost on the line: no answer comes, and it is asked for again.
void StartUp::send(MessageId id, Bytes data) {
  const auto room = std::span(output_).subspan(output_size_);
  if (kShortHeader + data.size() + 1 > room.size()) return;
  output_size_ += write_message(id, data, room);
}

void StartUp::enter(Step step, std::int64_t now_ns) {
  step_ = step;
  refusal_.clear();
  tries_ = 0;
  try_step(now_ns);
}

void StartUp::try_step(std::int64_t now_ns) {
  const Request& request = request_of(step_);
  if (tries_++ == request.tries) return give_up(now_ns);
  due_ns_ = now_ns + request.patience_ns;
  output_size_ = 0;
  if (step_ == Step::set_baud) {
    const std::uint8_t code = *code_of(settings_.baud);
    return send(request.id, Bytes(&code, 1));
  }
  if (step_ != Step::set_output) return send(request.id, {});
  std::array<Output, kMostOutputs> outputs;
  const std::size_t count = outputs_of(settings_, outputs);
  std::array<std::uint8_t, kMostOutputs * kOutputSize> data{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto id = static_cast<unsigned>(outputs[i].id);
    const auto hertz = static_cast<unsigned>(outputs[i].hertz);
    const std::size_t at = i * kOutputSize;
    data[at] = static_cast<std::uint8_t>(id >> 8U);
    data[at + 1] = static_cast<std::uint8_t>(id);
    data[at + 2] = static_cast<std::uint8_t>(hertz >> 8U);
    data[at + 3] = static_cast<std::uint8_t>(hertz);
  }
  send(request.id, Bytes(data).first(count * kOutputSize));
}

void StartUp::give_up(std::int64_t now_ns) {
  if (step_ == Step::restart) {
    // The acknowledgement may have been lost to the change of the bit rate.
    baud_ = settings_.baud;
    return enter(Step::find_again, now_ns);
  }
  if (!refusal_.empty()) return fail(refusal_);
  if (step_ != Step::find) {
    return fail(std::string("the MTi does not answer ") + request_of(step_).name);
  }
  while (next_rate_ < kBaudCodes.size() && kBaudCodes[next_rate_].baud == settings_.baud) {
    ++next_rate_;
  }
  if (next_rate_ == kBaudCodes.size()) return fail("no Xsens MTi answers at any bit rate");
  baud_ = kBaudCodes[next_rate_++].baud;
  framer_ = Framer();
  enter(Step::find, now_ns);
}

void StartUp::fail(std::string problem) {
  state_ = State::failed;
  problem_ = std::move(problem);
  output_size_ = 0;
}

void StartUp::take_message(const Message& message, std::int64_t now_ns) {
  const Request& request = request_of(step_);
  const bool is_searching = step_ == Step::find || step_ == Step::find_again;
  if (message.id == MessageId::wake_up && is_searching) {
    return send(MessageId::wake_up_ack, {});
  }
  if (message.id == MessageId::error) {
    const int code = message.data.empty() ? -1 : message.data[0];
    refusal_ = std::string("the MTi refuses ") + request.name + ": " + meaning_of(code) +
               " (error " + std::to_string(code) + ")";
    // While it measures it may say so of what went before, and the answer follows.
    if (!is_searching) fail(refusal_);
    return;
  }
  // It measures: its acknowledgement was lost.
  if (message.id == MessageId::mt_data2 && step_ == Step::go) return acknowledged({}, now_ns);
  const auto wanted = static_cast<std::uint8_t>(request.id) + 1;
  if (static_cast<std::uint8_t>(message.id) == wanted) acknowledged(message.data, now_ns);
}

void StartUp::acknowledged(Bytes data, std::int64_t now_ns) {
  switch (step_) {
    case Step::find:
      return enter(Step::identify, now_ns);
    case Step::identify:
      if (data.size() == sizeof(std::uint32_t)) device_id_ = read<std::uint32_t>(data, 0);
      if (data.size() == sizeof(std::uint64_t)) device_id_ = read<std::uint64_t>(data, 0);
      if (baud_ == settings_.baud) return enter(Step::set_output, now_ns);
      if (code_of(settings_.baud)) return enter(Step::set_baud, now_ns);
      return fail("the MTi runs at " + std::to_string(baud_) +
                  " bit/s and knows no imu.baud = " + std::to_string(settings_.baud));
    case Step::set_baud:
      return enter(Step::restart, now_ns);
    case Step::restart:
      baud_ = settings_.baud;
      return enter(Step::find_again, now_ns);
    case Step::find_again:
      return enter(Step::set_output, now_ns);
    case Step::set_output:
      compare_outputs(data);
      return enter(Step::go, now_ns);
    case Step::go:
      state_ = State::measuring;
      due_ns_ = std::numeric_limits<std::int64_t>::max();
      return;
  }
}

void StartUp::compare_outputs(Bytes data) {
  std::array<Output, kMostOutputs> outputs;
  const std::size_t count = outputs_of(settings_, outputs);
  for (std::size_t i = 0; i < count; ++i) {
    if (outputs[i].hertz == kWithEveryMessage) continue;
    int hertz = 0;
    for (std::size_t at = 0; at + kOutputSize <= data.size(); at += kOutputSize) {
      if (static_cast<DataId>(read<std::uint16_t>(data, at)) == outputs[i].id) {
        hertz = read<std::uint16_t>(data, at + 2);
      }
    }
    if (hertz == outputs[i].hertz) continue;
    const char* const name = outputs[i].id == DataId::quaternion     ? "orientation"
                             : outputs[i].id == DataId::acceleration ? "acceleration"
                             : outputs[i].id == DataId::rate_of_turn ? "rate of turn"
                             : outputs[i].id == DataId::acceleration_hr
                                 ? "acceleration at high rate"
                                 : "rate of turn at high rate";
    note_ += std::string(note_.empty() ? "the MTi gives " : ", ") + name + " at " +
             std::to_string(hertz) + " Hz instead of " + std::to_string(outputs[i].hertz);
  }
}

}  // namespace scree::xsens
