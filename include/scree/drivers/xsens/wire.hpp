#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

// The Xbus messages of an Xsens MTi, as the "MT Low Level Communication Protocol Documentation"
// (MT0101P) describes them. All numbers are big-endian.
namespace scree::xsens {

using Bytes = std::span<const std::uint8_t>;

// A message: preamble, bus id, message id, length, data, checksum (section "Message structure").
// All bytes but the preamble add up to 0 modulo 256.
inline constexpr std::uint8_t kPreamble = 0xFA;
inline constexpr std::uint8_t kMasterDevice = 0xFF;    // bus id of a device that is not on a bus
inline constexpr std::uint8_t kExtendedLength = 0xFF;  // two bytes with the length follow
inline constexpr std::size_t kLongestData = 2048;
inline constexpr std::size_t kShortHeader = 4, kExtendedHeader = 6;
inline constexpr std::size_t kLongestMessage = kExtendedHeader + kLongestData + 1;

/// The acknowledgement of a message has the next id.
enum class MessageId : std::uint8_t {
  request_device_id = 0x00,
  device_id = 0x01,
  go_to_measurement = 0x10,
  go_to_measurement_ack = 0x11,
  set_baud_rate = 0x18,
  set_baud_rate_ack = 0x19,
  go_to_config = 0x30,
  go_to_config_ack = 0x31,
  mt_data2 = 0x36,
  wake_up = 0x3E,
  wake_up_ack = 0x3F,
  reset = 0x40,
  reset_ack = 0x41,
  error = 0x42,
  set_output_configuration = 0xC0,
  set_output_configuration_ack = 0xC1
};

// MTData2 holds packets of data id (two bytes), size (one byte) and data (section "MTData2"). The
// lowest four bits of an id say format and frame.
enum class DataId : std::uint16_t {
  temperature = 0x0810,           ///< degrees Celsius
  utc_time = 0x1010,              ///< see UtcTime
  packet_counter = 0x1020,        ///< uint16, counts messages, wraps
  itow = 0x1030,                  ///< uint32, GPS time of the week, ms
  gnss_age = 0x1040,              ///< uint8, packets since the GNSS data
  pressure_age = 0x1050,          ///< uint8, packets since the pressure was measured
  sample_time_fine = 0x1060,      ///< uint32, 1/10,000 s, wraps
  sample_time_coarse = 0x1070,    ///< uint32, whole seconds
  frame_range = 0x1080,           ///< two uint16: first and last frame
  packet_counter8 = 0x1090,       ///< uint8, as packet_counter
  sample_time64 = 0x10A0,         ///< uint64, 1/10,000 s
  quaternion = 0x2010,            ///< w, x, y, z: rotates the sensor's axes into the local frame
  rotation_matrix = 0x2020,       ///< the same, column after column
  euler_angles = 0x2030,          ///< roll, pitch, yaw, degrees: Rz(yaw) Ry(pitch) Rx(roll)
  baro_pressure = 0x3010,         ///< uint32, Pa
  delta_v = 0x4010,               ///< x, y, z: integral of the specific force, m/s
  acceleration = 0x4020,          ///< x, y, z: specific force in the sensor's axes, m/s^2
  free_acceleration = 0x4030,     ///< x, y, z: without gravity, in the local frame, m/s^2
  acceleration_hr = 0x4040,       ///< as acceleration, at a high rate
  trigger_in1 = 0x4810,           ///< see TriggerIndication
  trigger_in2 = 0x4820,           ///< the same
  trigger_in3 = 0x4830,           ///< the same
  altitude_msl = 0x5010,          ///< metres above mean sea level
  altitude_ellipsoid = 0x5020,    ///< metres above the WGS84 ellipsoid
  position_ecef = 0x5030,         ///< x, y, z: earth-centred, earth-fixed, metres
  latitude_longitude = 0x5040,    ///< degrees
  gnss_pvt_data = 0x7010,         ///< see GnssPvtData
  gnss_sat_info = 0x7020,         ///< see GnssSatInfo
  gnss_pvt_pulse = 0x7030,        ///< uint32, time of the receiver's pulse
  rate_of_turn = 0x8020,          ///< x, y, z: in the sensor's axes, rad/s
  delta_q = 0x8030,               ///< w, x, y, z: how far the sensor turned since the last one
  rate_of_turn_hr = 0x8040,       ///< as rate_of_turn, at a high rate
  raw_acc_gyr_mag_temp = 0xA010,  ///< see RawSample
  raw_gyro_temp = 0xA020,         ///< three int16
  analog_in1 = 0xB010,            ///< uint16
  analog_in2 = 0xB020,            ///< uint16
  magnetic_field = 0xC020,        ///< x, y, z: in the sensor's axes, 1 is the field at calibration
  magnetic_field_corrected = 0xC030,  ///< the same after the in-run calibration
  velocity = 0xD010,                  ///< x, y, z: in the local frame, m/s
  status_byte = 0xE010,               ///< uint8, the lowest bits of the status word
  status_word = 0xE020,               ///< uint32, bits as in the section "StatusWord"
  rssi = 0xE040,                      ///< int8, dBm
  device_id = 0xE080,                 ///< uint32, or uint64 where ids are long
  location_id = 0xE090                ///< uint16
};
inline constexpr std::uint16_t kFormatBits = 0x0003;
inline constexpr std::uint16_t kFrameBits = 0x000C;

/// How a real number lies on the wire (section "Output format"); the fixed-point ones are signed.
enum class Format : std::uint16_t {
  float32 = 0x0,
  fixed1220 = 0x1,  ///< 32 bits, 20 of them behind the point
  fixed1632 = 0x2,  ///< the 32 bits behind the point first, then the 16 before it
  float64 = 0x3
};
inline constexpr std::array<std::size_t, 4> kFormatSizes = {4, 4, 6, 8};

enum class LocalFrame : std::uint16_t { enu = 0x0, ned = 0x4, nwu = 0x8 };

inline constexpr std::int64_t kTickNs = 100'000;               // of the sample time
inline constexpr std::int64_t kTickPeriodNs = kTickNs << 32U;  // after which it wraps

// Bits of the status word.
inline constexpr std::uint32_t kSelftestPassed = 1U << 0U;
inline constexpr std::uint32_t kFilterValid = 1U << 1U;

/// Reads an unsigned integer. @pre offset + sizeof(T) <= bytes.size()
template <class T>
constexpr T read(Bytes bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value = value << 8U | bytes[offset + i];
  return static_cast<T>(value);
}

/// Reads a real number. @pre offset + kFormatSizes[format] <= bytes.size()
constexpr double read_real(Bytes bytes, std::size_t offset, Format format) {
  switch (format) {
    case Format::float32:
      return static_cast<double>(std::bit_cast<float>(read<std::uint32_t>(bytes, offset)));
    case Format::fixed1220:
      return read<std::int32_t>(bytes, offset) / 0x1p20;
    case Format::fixed1632:
      return read<std::int16_t>(bytes, offset + 4) + read<std::uint32_t>(bytes, offset) / 0x1p32;
    case Format::float64:
      break;
  }
  return std::bit_cast<double>(read<std::uint64_t>(bytes, offset));
}

}  // namespace scree::xsens
