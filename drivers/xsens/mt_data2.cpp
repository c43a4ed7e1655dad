#include "scree/drivers/xsens/mt_data2.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace scree::xsens {
namespace {

constexpr std::size_t kItemHeader = 3;

/// How far the numbers of a rotation may be off; the coarsest format has steps of 1e-6.
constexpr double kRotationTolerance = 0.01;

struct Item {
  std::uint16_t id;
  Bytes data;

  Format format() const { return static_cast<Format>(id & kFormatBits); }
  LocalFrame frame() const { return static_cast<LocalFrame>(id & kFrameBits); }
};

/// Reads fields one after the other. @pre the item is long enough
class Fields {
public:
  explicit Fields(Bytes data) : data_(data) {}

  template <class... T>
  void operator()(T&... fields) {
    ((fields = read<T>(data_, offset_), offset_ += sizeof(T)), ...);
  }
  void skip(std::size_t bytes) { offset_ += bytes; }

private:
  Bytes data_;
  std::size_t offset_ = 0;
};

template <std::size_t N>
Refusal real(const Item& item, std::optional<Numbers<N>>& out) {
  const std::size_t size = kFormatSizes[static_cast<std::size_t>(item.format())];
  if (item.data.size() != N * size) return Refusal::size;
  Numbers<N> numbers{{}, item.format(), item.frame()};
  for (std::size_t i = 0; i < N; ++i) {
    numbers.value[i] = read_real(item.data, i * size, item.format());
    if (!std::isfinite(numbers.value[i])) return Refusal::not_finite;
  }
  out = numbers;
  return Refusal::none;
}

template <class T>
Refusal integer(const Item& item, std::optional<T>& out) {
  if (item.data.size() != sizeof(T)) return Refusal::size;
  out = read<T>(item.data, 0);
  return Refusal::none;
}

Refusal rotation(const Item& item, std::optional<Quaternion>& out) {
  std::optional<Quaternion> quaternion;
  if (const Refusal refusal = real(item, quaternion); refusal != Refusal::none) return refusal;
  const auto& [w, x, y, z] = quaternion->value;
  const double norm = std::hypot(std::hypot(w, x), std::hypot(y, z));
  if (std::abs(norm - 1) > kRotationTolerance) return Refusal::not_unit;
  out = quaternion;
  return Refusal::none;
}

Refusal rotation(const Item& item, std::optional<Matrix3>& out) {
  std::optional<Matrix3> matrix;
  if (const Refusal refusal = real(item, matrix); refusal != Refusal::none) return refusal;
  const Eigen::Map<const Eigen::Matrix3d> columns(matrix->value.data());
  const Eigen::Matrix3d product = columns.transpose() * columns;
  const double off = (product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= 2 * kRotationTolerance) || columns.determinant() < 0) return Refusal::not_unit;
  out = matrix;
  return Refusal::none;
}

Refusal utc_time(const Item& item, std::optional<UtcTime>& out) {
  if (item.data.size() != 12) return Refusal::size;
  UtcTime& utc = out.emplace();
  Fields(item.data)(utc.nanosecond, utc.year, utc.month, utc.day, utc.hour, utc.minute, utc.second,
                    utc.valid);
  return Refusal::none;
}

Refusal frame_range(const Item& item, std::optional<FrameRange>& out) {
  if (item.data.size() != 4) return Refusal::size;
  FrameRange& range = out.emplace();
  Fields(item.data)(range.first, range.last);
  return Refusal::none;
}

Refusal trigger(const Item& item, std::optional<TriggerIndication>& out) {
  if (item.data.size() != 8) return Refusal::size;
  TriggerIndication& trigger = out.emplace();
  Fields(item.data)(trigger.line, trigger.polarity, trigger.timestamp, trigger.frame);
  return Refusal::none;
}

Refusal gnss_pvt_data(const Item& item, std::optional<GnssPvtData>& out) {
  if (item.data.size() != 94) return Refusal::size;
  GnssPvtData& pvt = out.emplace();
  Fields(item.data)(
      pvt.itow, pvt.year, pvt.month, pvt.day, pvt.hour, pvt.minute, pvt.second, pvt.valid,
      pvt.time_accuracy, pvt.nanosecond, pvt.fix_type, pvt.flags, pvt.satellites, pvt.reserved,
      pvt.longitude, pvt.latitude, pvt.height, pvt.height_msl, pvt.horizontal_accuracy,
      pvt.vertical_accuracy, pvt.velocity_north, pvt.velocity_east, pvt.velocity_down,
      pvt.ground_speed, pvt.heading_of_motion, pvt.speed_accuracy, pvt.heading_accuracy,
      pvt.heading_of_vehicle, pvt.gdop, pvt.pdop, pvt.tdop, pvt.vdop, pvt.hdop, pvt.ndop, pvt.edop);
  return Refusal::none;
}

Refusal gnss_sat_info(const Item& item, std::optional<GnssSatInfo>& out) {
  constexpr std::size_t kHead = 8, kEach = 4;
  if (item.data.size() < kHead) return Refusal::size;
  const std::size_t count = item.data[4];
  if (count > GnssSatInfo::kMost || item.data.size() < kHead + count * kEach) return Refusal::size;
  GnssSatInfo& info = out.emplace();
  Fields fields(item.data);
  fields(info.itow, info.count);
  fields.skip(3);
  for (std::size_t i = 0; i < count; ++i) {
    GnssSatellite& satellite = info.satellites[i];
    fields(satellite.gnss, satellite.satellite, satellite.carrier_to_noise, satellite.flags);
  }
  return Refusal::none;
}

Refusal raw_sample(const Item& item, std::optional<RawSample>& out) {
  if (item.data.size() != 20) return Refusal::size;
  RawSample& raw = out.emplace();
  Fields fields(item.data);
  for (auto* part : {&raw.acceleration, &raw.rate_of_turn, &raw.magnetic_field}) {
    for (std::uint16_t& value : *part) fields(value);
  }
  fields(raw.temperature);
  return Refusal::none;
}

Refusal raw_gyro_temperatures(const Item& item, std::optional<std::array<std::int16_t, 3>>& out) {
  if (item.data.size() != 6) return Refusal::size;
  Fields fields(item.data);
  for (std::int16_t& value : out.emplace()) fields(value);
  return Refusal::none;
}

Refusal device_id(const Item& item, std::optional<std::uint64_t>& out) {
  if (item.data.size() == sizeof(std::uint64_t)) return integer(item, out);
  std::optional<std::uint32_t> id;
  const Refusal refusal = integer(item, id);
  if (id) out = *id;
  return refusal;
}

// The items by their groups. Nothing where the id is none of the group.

/// Time stamps and counters (group 0x10).
std::optional<Refusal> decode_time(DataId id, const Item& item, Measurement& out) {
  switch (id) {
    case DataId::utc_time:
      return utc_time(item, out.utc_time);
    case DataId::packet_counter:
      return integer(item, out.packet_counter);
    case DataId::itow:
      return integer(item, out.itow);
    case DataId::gnss_age:
      return integer(item, out.gnss_age);
    case DataId::pressure_age:
      return integer(item, out.pressure_age);
    case DataId::sample_time_fine:
      return integer(item, out.sample_time_fine);
    case DataId::sample_time_coarse:
      return integer(item, out.sample_time_coarse);
    case DataId::frame_range:
      return frame_range(item, out.frame_range);
    case DataId::packet_counter8:
      return integer(item, out.packet_counter8);
    case DataId::sample_time64:
      return integer(item, out.sample_time64);
    default:
      return std::nullopt;
  }
}

/// Orientation, acceleration, rate of turn, magnetic field and velocity (groups 0x20, 0x40, 0x80,
/// 0xC0, 0xD0).
std::optional<Refusal> decode_inertial(DataId id, const Item& item, Measurement& out) {
  switch (id) {
    case DataId::quaternion:
      return rotation(item, out.quaternion);
    case DataId::rotation_matrix:
      return rotation(item, out.rotation_matrix);
    case DataId::euler_angles:
      return real(item, out.euler_angles);
    case DataId::delta_v:
      return real(item, out.delta_v);
    case DataId::acceleration:
      return real(item, out.acceleration);
    case DataId::free_acceleration:
      return real(item, out.free_acceleration);
    case DataId::acceleration_hr:
      return real(item, out.acceleration_hr);
    case DataId::rate_of_turn:
      return real(item, out.rate_of_turn);
    case DataId::delta_q:
      return rotation(item, out.delta_q);
    case DataId::rate_of_turn_hr:
      return real(item, out.rate_of_turn_hr);
    case DataId::magnetic_field:
      return real(item, out.magnetic_field);
    case DataId::magnetic_field_corrected:
      return real(item, out.magnetic_field_corrected);
    case DataId::velocity:
      return real(item, out.velocity);
    default:
      return std::nullopt;
  }
}

/// Position and GNSS (groups 0x50 and 0x70).
std::optional<Refusal> decode_position(DataId id, const Item& item, Measurement& out) {
  switch (id) {
    case DataId::altitude_msl:
      return real(item, out.altitude_msl);
    case DataId::altitude_ellipsoid:
      return real(item, out.altitude_ellipsoid);
    case DataId::position_ecef:
      return real(item, out.position_ecef);
    case DataId::latitude_longitude:
      return real(item, out.latitude_longitude);
    case DataId::gnss_pvt_data:
      return gnss_pvt_data(item, out.gnss_pvt_data);
    case DataId::gnss_sat_info:
      return gnss_sat_info(item, out.gnss_sat_info);
    case DataId::gnss_pvt_pulse:
      return integer(item, out.gnss_pvt_pulse);
    default:
      return std::nullopt;
  }
}

/// Temperature, pressure, triggers, raw values and status (the other groups).
std::optional<Refusal> decode_other(DataId id, const Item& item, Measurement& out) {
  switch (id) {
    case DataId::temperature:
      return real(item, out.temperature);
    case DataId::baro_pressure:
      return integer(item, out.baro_pressure);
    case DataId::trigger_in1:
      return trigger(item, out.trigger_in[0]);
    case DataId::trigger_in2:
      return trigger(item, out.trigger_in[1]);
    case DataId::trigger_in3:
      return trigger(item, out.trigger_in[2]);
    case DataId::raw_acc_gyr_mag_temp:
      return raw_sample(item, out.raw_sample);
    case DataId::raw_gyro_temp:
      return raw_gyro_temperatures(item, out.raw_gyro_temperatures);
    case DataId::analog_in1:
      return integer(item, out.analog_in[0]);
    case DataId::analog_in2:
      return integer(item, out.analog_in[1]);
    case DataId::status_byte:
      return integer(item, out.status_byte);
    case DataId::status_word:
      return integer(item, out.status_word);
    case DataId::rssi:
      return integer(item, out.rssi);
    case DataId::device_id:
      return device_id(item, out.device_id);
    case DataId::location_id:
      return integer(item, out.location_id);
    default:
      return std::nullopt;
  }
}

/// Nothing when the id is unknown.
std::optional<Refusal> decode(const Item& item, Measurement& out) {
  constexpr std::uint16_t kTypeBits = 0xFFF0;
  const auto id = static_cast<DataId>(item.id & kTypeBits);
  if (const auto refusal = decode_inertial(id, item, out)) return refusal;
  if (const auto refusal = decode_time(id, item, out)) return refusal;
  if (const auto refusal = decode_position(id, item, out)) return refusal;
  return decode_other(id, item, out);
}

}  // namespace

Measurement decode_mt_data2(Bytes data, ItemCounts& counts) {
  const auto refuse = [&](Refusal reason) { ++counts.refused[static_cast<std::size_t>(reason)]; };
  Measurement measurement;
  while (!data.empty()) {
    if (data.size() < kItemHeader || data.size() < kItemHeader + data[2]) {
      refuse(Refusal::truncated);
      break;
    }
    const Item item{read<std::uint16_t>(data, 0), data.subspan(kItemHeader, data[2])};
    data = data.subspan(kItemHeader + item.data.size());
    const std::optional<Refusal> refusal = decode(item, measurement);
    if (!refusal) {
      ++counts.unknown;
    } else if (*refusal == Refusal::none) {
      ++counts.decoded;
    } else {
      refuse(*refusal);
    }
  }
  return measurement;
}

}  // namespace scree::xsens
