#include "scree/drivers/velodyne/position_packet.hpp"

#include <charconv>
#include <chrono>

namespace scree::velodyne {
namespace {

constexpr std::string_view kNothing;

/// Takes the next comma-separated field off the front.
std::string_view next_field(std::string_view& rest) {
  const std::size_t comma = rest.find(',');
  const std::string_view field = rest.substr(0, comma);
  rest = comma == std::string_view::npos ? kNothing : rest.substr(comma + 1);
  return field;
}

template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Two digits.
std::optional<unsigned> pair(std::string_view text, std::size_t offset) {
  if (text.size() < offset + 2) return std::nullopt;
  return number<unsigned>(text.substr(offset, 2));
}

/// hhmmss[.sss] and ddmmyy; the century is that of the VLP-16.
std::optional<std::int64_t> utc_ns(std::string_view time, std::string_view date) {
  namespace chrono = std::chrono;
  const auto h = pair(time, 0), m = pair(time, 2), s = pair(time, 4);
  const auto day_of = pair(date, 0), month_of = pair(date, 2), year_of = pair(date, 4);
  if (!h || !m || !s || !day_of || !month_of || !year_of || date.size() != 6) return std::nullopt;
  if (*h > 23 || *m > 59 || *s > 60) return std::nullopt;
  const chrono::year_month_day ymd(chrono::year(2000 + static_cast<int>(*year_of)),
                                   chrono::month(*month_of), chrono::day(*day_of));
  if (!ymd.ok()) return std::nullopt;
  std::int64_t fraction_ns = 0;
  if (time.size() > 6) {
    const auto fraction = number<double>(time.substr(6));
    if (!fraction || !(*fraction >= 0.0 && *fraction < 1.0)) return std::nullopt;
    fraction_ns = static_cast<std::int64_t>(*fraction * 1e9);
  }
  const auto whole = chrono::sys_days(ymd).time_since_epoch() + chrono::hours(*h) +
                     chrono::minutes(*m) + chrono::seconds(*s);
  return chrono::nanoseconds(whole).count() + fraction_ns;
}

/// Degrees and minutes as one number (ddmm.mmmm) with the letter of the half sphere.
std::optional<double> angle_deg(std::string_view text, std::string_view half, char positive,
                                char negative, double limit) {
  const auto value = number<double>(text);
  if (!value || half.size() != 1 || (half[0] != positive && half[0] != negative))
    return std::nullopt;
  if (!(*value >= 0.0 && *value < 100.0 * limit + 1.0)) return std::nullopt;
  const double whole = static_cast<double>(static_cast<int>(*value / 100.0));
  const double angle = whole + (*value - 100.0 * whole) / 60.0;
  return half[0] == positive ? angle : -angle;
}

/// The text between $ and *, if the checksum behind it is right.
std::optional<std::string_view> checked(std::string_view sentence) {
  const std::size_t star = sentence.find('*');
  if (sentence.empty() || sentence[0] != '$' || star == std::string_view::npos ||
      sentence.size() < star + 3) {
    return std::nullopt;
  }
  const std::string_view text = sentence.substr(1, star - 1);
  unsigned sum = 0, expected = 0;
  for (const char c : text) sum ^= static_cast<unsigned char>(c);
  const char* const digits = sentence.data() + star + 1;
  const auto [end, error] = std::from_chars(digits, digits + 2, expected, 16);
  if (error != std::errc() || end != digits + 2 || sum != expected) return std::nullopt;
  return text;
}

}  // namespace

std::optional<Gprmc> parse_gprmc(std::string_view sentence) {
  const auto text = checked(sentence);
  if (!text) return std::nullopt;
  std::string_view rest = *text;
  const std::string_view name = next_field(rest);
  if (name != "GPRMC" && name != "GNRMC") return std::nullopt;
  const std::string_view time = next_field(rest), status = next_field(rest);
  const std::string_view latitude = next_field(rest), north = next_field(rest);
  const std::string_view longitude = next_field(rest), east = next_field(rest);
  next_field(rest);  // speed
  next_field(rest);  // course
  Gprmc gprmc;
  gprmc.fix = status == "A";
  gprmc.utc_ns = utc_ns(time, next_field(rest));
  gprmc.latitude_deg = angle_deg(latitude, north, 'N', 'S', 90);
  gprmc.longitude_deg = angle_deg(longitude, east, 'E', 'W', 180);
  return gprmc;
}

std::optional<PositionPacket> parse_position_packet(Bytes datagram) {
  if (datagram.size() != kPositionPacketSize) return std::nullopt;
  PositionPacket packet;
  packet.timestamp_us = read<std::uint32_t>(datagram, kPositionTimestampOffset);
  const std::uint8_t pps = datagram[kPpsStatusOffset];
  if (pps < kPpsNames.size()) packet.pps = static_cast<PpsStatus>(pps);
  const std::string_view nmea(reinterpret_cast<const char*>(datagram.data()) + kNmeaOffset,
                              datagram.size() - kNmeaOffset);
  constexpr std::string_view kEnds("\r\n\0", 3);
  packet.sentence = nmea.substr(0, nmea.find_first_of(kEnds));
  packet.gprmc = parse_gprmc(packet.sentence);
  return packet;
}

}  // namespace scree::velodyne
