#include "scree/drivers/xsens/device.hpp"

#include <limits>
#include <utility>

#include "scree/core/nanoseconds.hpp"

namespace scree::xsens {
namespace {

/// Between attempts to open a port that has gone ...
constexpr std::int64_t kReopenAfter = kSecond / 2;
/// ... and to start an MTi that did not answer or refused.
constexpr std::int64_t kRestartAfter = 2 * kSecond;
/// A device without data for so long is started anew: it may have lost its power, or be another.
constexpr std::int64_t kSilence = 2 * kSecond;

}  // namespace

Device::Device(const ImuSettings& settings) : settings_(settings), start_up_(settings) {}

Result<Device> Device::open(const ImuSettings& settings) {
  if (const auto reason = line_too_slow(settings)) return fail(*reason);
  Device device(settings);
  auto port = SerialPort::open(settings.device, settings.baud);
  if (!port) return tl::make_unexpected(port.error());
  device.port_ = std::move(*port);
  return device;
}

std::int64_t Device::due_ns() const {
  switch (state_) {
    case DeviceState::lost:
      return retry_ns_;
    case DeviceState::starting:
      return start_up_.due_ns();
    case DeviceState::measuring:
      break;
  }
  return settings_.configure ? last_data_ns_ + kSilence : std::numeric_limits<std::int64_t>::max();
}

std::optional<ReceivedBytes> Device::advance(std::int64_t now_ns) {
  if (state_ == DeviceState::lost) {
    if (now_ns < retry_ns_) return std::nullopt;
    reopen(now_ns);
  }
  if (state_ == DeviceState::starting) go_on_starting(now_ns);
  if (state_ != DeviceState::measuring) return std::nullopt;

  ReceivedBytes received;
  const SerialPort::Reading reading = port_->receive(buffer_, received);
  if (reading == SerialPort::Reading::lost) {
    lose_port(now_ns);
    return std::nullopt;
  }
  const bool has_bytes = reading == SerialPort::Reading::bytes;
  if (has_bytes) {
    counts_.bytes += received.bytes.size();
    framer_.take(received.bytes, [&](const Message& message) {
      if (message.id == MessageId::mt_data2) last_data_ns_ = now_ns;
    });
  }
  if (settings_.configure && now_ns - last_data_ns_ >= kSilence) {
    ++counts_.silences;
    problem_ = "the IMU on " + settings_.device +
               (has_bytes ? " sends nothing that can be understood" : " has stopped sending");
    start(now_ns);
  }
  return has_bytes ? std::optional(received) : std::nullopt;
}

void Device::reopen(std::int64_t now_ns) {
  if (!port_) {
    auto port = SerialPort::open(settings_.device, settings_.baud);
    if (!port) return lose(port.error().message, now_ns + kReopenAfter);
    port_ = std::move(*port);
  }
  start(now_ns);
}

void Device::start(std::int64_t now_ns) {
  state_ = DeviceState::starting;
  line_baud_ = 0;
  start_up_.begin(now_ns);
  serve_start_up(now_ns);
}

void Device::go_on_starting(std::int64_t now_ns) {
  ReceivedBytes received;
  const SerialPort::Reading reading = port_->receive(buffer_, received);
  if (reading == SerialPort::Reading::lost) return lose_port(now_ns);
  if (reading == SerialPort::Reading::bytes) start_up_.take(received.bytes, now_ns);
  start_up_.advance(now_ns);
  serve_start_up(now_ns);
}

void Device::serve_start_up(std::int64_t now_ns) {
  if (start_up_.baud() != line_baud_) {
    // Bit rates that the port cannot do are passed over: no answer will come.
    const auto set = port_->set_baud(start_up_.baud());
    if (!set && start_up_.baud() == settings_.baud) {
      return lose(set.error().message, now_ns + kRestartAfter);
    }
    line_baud_ = start_up_.baud();
  }
  // What does not go out is sent again when no answer comes.
  if (const Bytes output = start_up_.take_output(); !output.empty()) port_->send(output);
  if (start_up_.state() == StartUp::State::failed) {
    lose(start_up_.problem() + " (on " + settings_.device + ")", now_ns + kRestartAfter);
  } else if (start_up_.state() == StartUp::State::measuring) {
    state_ = DeviceState::measuring;
    last_data_ns_ = now_ns;
    framer_ = Framer();
    ++counts_.starts;
  }
}

void Device::lose_port(std::int64_t now_ns) {
  ++counts_.losses;
  lose("the serial port " + settings_.device + " has gone: was the IMU unplugged?",
       now_ns + kReopenAfter);
}

void Device::lose(std::string problem, std::int64_t retry_ns) {
  problem_ = std::move(problem);
  port_.reset();
  state_ = DeviceState::lost;
  retry_ns_ = retry_ns;
}

}  // namespace scree::xsens
