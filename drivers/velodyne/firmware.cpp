#include "scree/drivers/velodyne/firmware.hpp"

namespace scree::velodyne {
namespace {

/// So many packets in a row that say otherwise change a decision.
constexpr int kPacketsToChange = 16;

/// What a time between two packets says, in microseconds. The lost packets of an HDL-32E never add
/// up to a VLP-16's time: 553 and 276 have no multiple near 1327 or 664.
Firmware kind_of(std::uint32_t microseconds) {
  constexpr std::uint32_t kTolerance = 15;
  const auto near = [&](std::uint32_t expected) {
    return microseconds + kTolerance >= expected && microseconds <= expected + kTolerance;
  };
  if (near(1327) || near(664)) return Firmware::early_vlp16;
  if (near(553) || near(276)) return Firmware::hdl32e;
  return Firmware::undecided;
}

}  // namespace

std::string_view sentence(Firmware firmware) {
  switch (firmware) {
    case Firmware::early_vlp16:
      return "the sensor writes product byte 0x21, as a VLP-16 with early firmware does; by its "
             "packet rate it is one, so its packets are used";
    case Firmware::hdl32e:
      return "the sensor writes product byte 0x21 and has the packet rate of an HDL-32E, which is "
             "not supported; its packets are refused";
    case Firmware::undecided:
      break;
  }
  return "";
}

Firmware FirmwareDetector::update(std::uint32_t timestamp_us) {
  if (last_us_) {
    const std::uint32_t elapsed = (timestamp_us + kHourUs - *last_us_) % kHourUs;
    const Firmware kind = kind_of(elapsed);
    if (firmware_ == Firmware::undecided) firmware_ = kind;
    if (kind == firmware_) against_ = 0;
    if (kind != Firmware::undecided && kind != firmware_ && ++against_ >= kPacketsToChange) {
      firmware_ = kind;
      against_ = 0;
    }
  }
  last_us_ = timestamp_us;
  return firmware_;
}

}  // namespace scree::velodyne
