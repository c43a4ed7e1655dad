#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/refusal.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// What a single datagram on the data port shows by itself; any bytes are safe. Product 0x21 passes
/// for a VLP-16 or Puck LITE: only the timing of several packets tells (see Firmware).
Refusal check_data_packet(Bytes datagram, LidarModel model);

/// Microseconds past the hour of the packet's first shot. @pre checked
inline std::uint32_t timestamp_us(Bytes packet) {
  return read<std::uint32_t>(packet, kTimestampOffset) % kHourUs;
}
/// @pre checked
inline ReturnMode return_mode(Bytes packet) {
  return static_cast<ReturnMode>(packet[kReturnModeOffset]);
}
/// @pre checked
inline Product product(Bytes packet) {
  return static_cast<Product>(packet[kProductOffset]);
}

template <class T>
using PerShot = std::array<T, kShots>;

/// The shots of a packet, one array a quantity, in the order of the wire: 32 a block, laser id in
/// the firing order. A shot without return has range 0 and lies kNoReturnRange off.
struct Shots {
  PerShot<float> x, y, z;       ///< metres, `lidar` frame
  PerShot<float> range;         ///< metres; 0 is no return
  PerShot<float> reflectivity;  ///< 0..255
  PerShot<float> azimuth;       ///< of that very shot; hundredths of a degree, [0, 36000)
  std::span<const std::int32_t, kShots> time_ns;  ///< since the packet's time stamp
  /// Shots in the order of time; with dual returns the two returns of a shot follow each other.
  std::span<const std::uint16_t, kShots> firing_order;
  ReturnMode mode = ReturnMode::strongest;
  float degrees_per_block = 0;  ///< how far it turned from block to block (pair to pair if dual)
  /// Where a field of view is set in the sensor: the degrees that it skipped inside the packet, and
  /// the azimuth where it went on, hundredths of a degree, -1 where it skipped none.
  float skipped_deg = 0, resumed_at = -1;

  Shots();
};

constexpr std::size_t block_of(std::size_t shot) {
  return shot / kShotsPerBlock;
}
constexpr std::size_t laser_of(std::size_t shot) {
  return shot % kLasers;
}

/// Decodes data packets (63-9243 Rev. D, sections 9.3 to 9.5): the azimuth of each shot lies
/// between those of its block and the next; behind the last block, and where the step to the next
/// block is none that a motor makes (a field of view is set in the sensor), the sensor turns on as
/// before. Behind such a step the manual leaves the time open; shots keep their regular spacing.
class PacketDecoder {
public:
  explicit PacketDecoder(LidarModel model);

  /// @pre check_data_packet() passed it
  void decode(Bytes packet, Shots& shots) const;

private:
  void decode_block(const std::uint8_t* block, unsigned azimuth, float step, std::size_t first,
                    Shots& shots) const;

  alignas(16) std::array<float, kShotsPerBlock> cos_elevation_, sin_elevation_, correction_;
};

}  // namespace scree::velodyne
