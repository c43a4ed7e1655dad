#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// Which sensor writes product byte 0x21.
enum class Firmware : std::uint8_t {
  undecided,
  early_vlp16,  ///< a VLP-16 or Puck LITE with early firmware
  hdl32e        ///< an HDL-32E, whose byte it is
};

/// For the log; empty while undecided.
std::string_view sentence(Firmware firmware);

/// Tells the two apart by the time between packets that follow each other: 1327 us (dual returns:
/// 664) of a VLP-16, 553 us (276) of an HDL-32E. Times that are none of these (a packet was lost)
/// decide nothing. Once decided, it takes many packets of the other kind in a row to change it.
class FirmwareDetector {
public:
  /// Takes the time stamp of the next packet with that byte.
  Firmware update(std::uint32_t timestamp_us);
  Firmware firmware() const { return firmware_; }

private:
  Firmware firmware_ = Firmware::undecided;
  std::optional<std::uint32_t> last_us_;
  int against_ = 0;  ///< packets in a row that speak against the decision
};

}  // namespace scree::velodyne
