#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "scree/drivers/xsens/wire.hpp"

namespace scree::xsens {

/// The real numbers of an item, as sent.
template <std::size_t N>
struct Numbers {
  std::array<double, N> value{};
  Format format = Format::float32;
  LocalFrame frame = LocalFrame::enu;  ///< means something only where the item has a local frame

  double operator[](std::size_t i) const { return value[i]; }
};
using Number = Numbers<1>;
using Vector2 = Numbers<2>;
using Vector3 = Numbers<3>;
using Quaternion = Numbers<4>;  ///< w, x, y, z
using Matrix3 = Numbers<9>;     ///< column after column

/// Coordinated universal time by the device's clock, which need not be set.
struct UtcTime {
  std::uint32_t nanosecond;
  std::uint16_t year;
  std::uint8_t month, day, hour, minute, second;
  std::uint8_t valid;  ///< 1 time of the week, 2 week, 4 all of it
};

struct TriggerIndication {
  std::uint8_t line, polarity;
  std::uint32_t timestamp;
  std::uint16_t frame;
};

struct FrameRange {
  std::uint16_t first, last;
};

/// A fix of the GNSS receiver, 4 a second (table "Contents of GnssPvtData").
struct GnssPvtData {
  std::uint32_t itow;  ///< ms
  std::uint16_t year;
  std::uint8_t month, day, hour, minute, second;
  std::uint8_t valid;           ///< 1 date, 2 time, 4 fully resolved
  std::uint32_t time_accuracy;  ///< ns
  std::int32_t nanosecond;
  std::uint8_t fix_type;  ///< 0 none, 1 dead reckoning, 2 2D, 3 3D, 4 combined, 5 time only
  std::uint8_t flags, satellites, reserved;
  std::int32_t longitude, latitude;                           ///< 1e-7 degrees
  std::int32_t height, height_msl;                            ///< mm
  std::uint32_t horizontal_accuracy, vertical_accuracy;       ///< mm
  std::int32_t velocity_north, velocity_east, velocity_down;  ///< mm/s
  std::int32_t ground_speed;                                  ///< mm/s
  std::int32_t heading_of_motion;                             ///< 1e-5 degrees
  std::uint32_t speed_accuracy;                               ///< mm/s
  std::uint32_t heading_accuracy;                             ///< 1e-5 degrees
  std::int32_t heading_of_vehicle;                            ///< 1e-5 degrees
  std::uint16_t gdop, pdop, tdop, vdop, hdop, ndop, edop;     ///< 0.01
};

struct GnssSatellite {
  std::uint8_t gnss, satellite;
  std::uint8_t carrier_to_noise;  ///< dBHz
  std::uint8_t flags;             ///< 0x07 signal quality, 0x08 used, 0x30 health, 0x40 corrections
};

struct GnssSatInfo {
  static constexpr std::size_t kMost = 60;

  std::uint32_t itow;  ///< ms
  std::uint8_t count;  ///< of `satellites`
  std::array<GnssSatellite, kMost> satellites;
};

/// Counts of the sensor's converters (only of devices that do not calibrate by themselves).
struct RawSample {
  std::array<std::uint16_t, 3> acceleration, rate_of_turn, magnetic_field;
  std::int16_t temperature;  ///< 1/256 degree Celsius
};

/// What one MTData2 message holds, as sent; units and axes stand at DataId.
struct Measurement {
  std::optional<std::uint16_t> packet_counter;
  std::optional<std::uint8_t> packet_counter8;
  std::optional<std::uint32_t> sample_time_fine, sample_time_coarse;
  std::optional<std::uint64_t> sample_time64;
  std::optional<UtcTime> utc_time;
  std::optional<std::uint32_t> itow;
  std::optional<std::uint8_t> gnss_age, pressure_age;
  std::optional<FrameRange> frame_range;

  std::optional<Quaternion> quaternion;
  std::optional<Matrix3> rotation_matrix;
  std::optional<Vector3> euler_angles;

  std::optional<Vector3> acceleration, acceleration_hr, free_acceleration, delta_v;
  std::optional<Vector3> rate_of_turn, rate_of_turn_hr;
  std::optional<Quaternion> delta_q;
  std::optional<Vector3> magnetic_field, magnetic_field_corrected;

  std::optional<Number> temperature;
  std::optional<std::uint32_t> baro_pressure;

  std::optional<Number> altitude_msl, altitude_ellipsoid;
  std::optional<Vector3> position_ecef, velocity;
  std::optional<Vector2> latitude_longitude;
  std::optional<GnssPvtData> gnss_pvt_data;
  std::optional<GnssSatInfo> gnss_sat_info;
  std::optional<std::uint32_t> gnss_pvt_pulse;

  std::array<std::optional<TriggerIndication>, 3> trigger_in;
  std::array<std::optional<std::uint16_t>, 2> analog_in;
  std::optional<RawSample> raw_sample;
  std::optional<std::array<std::int16_t, 3>> raw_gyro_temperatures;

  std::optional<std::uint8_t> status_byte;
  std::optional<std::uint32_t> status_word;
  std::optional<std::int8_t> rssi;
  std::optional<std::uint64_t> device_id;
  std::optional<std::uint16_t> location_id;

  bool has_orientation() const { return quaternion || rotation_matrix || euler_angles; }
  bool has_rate() const { return rate_of_turn || rate_of_turn_hr || delta_q; }
  bool has_acceleration() const { return acceleration || acceleration_hr || delta_v; }
  /// Anything but what the GNSS receiver gave, which comes late and in messages of its own.
  bool is_inertial() const {
    return has_orientation() || has_rate() || has_acceleration() || free_acceleration ||
           magnetic_field || magnetic_field_corrected;
  }
};

}  // namespace scree::xsens
