#pragma once

#include <cstddef>
#include <cstdint>

// The Xbus messages of an Xsens MTi, as the "MT Low Level Communication Protocol Documentation"
// (MT0101P) describes them. All numbers are big-endian.
namespace scree::xsens {

// A message: preamble, bus id, message id, length, data, checksum (section "Message structure").
// All bytes but the preamble add up to 0 modulo 256.
inline constexpr std::uint8_t kPreamble = 0xFA;
inline constexpr std::uint8_t kMasterDevice = 0xFF;    // bus id of a device that is not on a bus
inline constexpr std::uint8_t kExtendedLength = 0xFF;  // two bytes with the length follow
inline constexpr std::size_t kLongestData = 2048;

enum class MessageId : std::uint8_t {
  device_id = 0x01,
  go_to_measurement = 0x10,
  go_to_measurement_ack = 0x11,
  go_to_config = 0x30,
  go_to_config_ack = 0x31,
  mt_data2 = 0x36,
  wake_up = 0x3E,
  error = 0x42,
  set_output_configuration = 0xC0,
  set_output_configuration_ack = 0xC1
};

// MTData2 holds packets of data id (two bytes), size (one byte) and data (section "MTData2"). The
// lowest four bits of an id say format and frame.
enum class DataId : std::uint16_t {
  packet_counter = 0x1020,    ///< uint16, counts messages, wraps
  sample_time_fine = 0x1060,  ///< uint32, 1/10,000 s, wraps
  quaternion = 0x2010,        ///< w, x, y, z: rotates the sensor's axes into the local frame
  euler_angles = 0x2030,      ///< roll, pitch, yaw, degrees
  acceleration = 0x4020,      ///< x, y, z: specific force in the sensor's axes, m/s^2
  rate_of_turn = 0x8020,      ///< x, y, z: in the sensor's axes, rad/s
  status_word = 0xE020        ///< uint32, bits as in the section "StatusWord"
};
inline constexpr std::uint16_t kFormatBits = 0x0003;
inline constexpr std::uint16_t kFrameBits = 0x000C;

enum class Format : std::uint16_t {
  float32 = 0x0,
  fixed1220 = 0x1,
  fixed1632 = 0x2,
  float64 = 0x3
};
enum class LocalFrame : std::uint16_t { enu = 0x0, ned = 0x4, nwu = 0x8 };

inline constexpr std::int64_t kTickNs = 100'000;  // of the sample time

// Bits of the status word.
inline constexpr std::uint32_t kSelftestPassed = 1U << 0U;
inline constexpr std::uint32_t kFilterValid = 1U << 1U;

}  // namespace scree::xsens
