#include "simulator/mti.hpp"

#include <array>

#include "simulator/xbus.hpp"

namespace scree {

using xsens::Bytes;
using xsens::MessageId;

std::vector<std::uint8_t> SimulatedMti::take(Bytes bytes) {
  std::vector<std::uint8_t> answers;
  framer_.take(bytes, [&](const xsens::Message& request) {
    const auto one = answer(request);
    answers.insert(answers.end(), one.begin(), one.end());
  });
  return answers;
}

std::vector<std::uint8_t> SimulatedMti::answer(const xsens::Message& request) {
  const auto acknowledge = [&](Bytes data) {
    return xbus_message(static_cast<MessageId>(static_cast<unsigned>(request.id) + 1), data);
  };
  // While it measures it hears nothing but this.
  if (is_measuring_ && request.id != MessageId::go_to_config) return {};
  switch (request.id) {
    case MessageId::go_to_config:
      is_measuring_ = false;
      return acknowledge({});
    case MessageId::request_device_id: {
      constexpr std::array<std::uint8_t, 4> kDeviceId = {0x07, 0x70, 0x00, 0x00};
      return acknowledge(kDeviceId);
    }
    case MessageId::set_baud_rate:
      return acknowledge({});
    case MessageId::set_output_configuration:
      return acknowledge(request.data);
    case MessageId::go_to_measurement:
    case MessageId::reset:
      is_measuring_ = true;
      return acknowledge({});
    case MessageId::wake_up_ack:
      return {};
    default: {
      constexpr std::array<std::uint8_t, 1> kUnknownMessage = {4};
      return xbus_message(MessageId::error, kUnknownMessage);
    }
  }
}

}  // namespace scree
