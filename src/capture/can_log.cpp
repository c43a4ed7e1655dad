#include "scree/capture/can_log.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <ctime>
#include <limits>
#include <numeric>
#include <utility>

#include "scree/capture/capture.hpp"
#include "scree/core/byte_order_mark.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000;  // CAN_ERR_FLAG of linux/can.h
constexpr std::size_t kClassicSize = 8;

/// A whole number of exactly these digits.
template <class T>
bool read_number(std::string_view digits, int base, T& value) {
  if (digits.empty()) return false;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value, base);
  return error == std::errc() && stop == end && digits.front() != '-';
}

/// Cuts off what stands before the separator, which must be there.
bool cut(std::string_view& text, char separator, std::string_view& before) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return false;
  before = text.substr(0, at);
  text.remove_prefix(at + 1);
  return true;
}

/// `2020-08-28 10:00:00` (candump -tA) in the time of the place where it is read: the log does not
/// say which it is.
bool read_date(std::string_view text, std::int64_t& seconds) {
  std::tm date{};
  std::string_view year, month, day, hour, minute;
  const bool is_read = cut(text, '-', year) && cut(text, '-', month) && cut(text, ' ', day) &&
                       cut(text, ':', hour) && cut(text, ':', minute) &&
                       read_number(year, 10, date.tm_year) && read_number(month, 10, date.tm_mon) &&
                       read_number(day, 10, date.tm_mday) && read_number(hour, 10, date.tm_hour) &&
                       read_number(minute, 10, date.tm_min) && read_number(text, 10, date.tm_sec);
  if (!is_read || date.tm_year < 1970 || date.tm_year > 9999) return false;
  date.tm_year -= 1900;
  date.tm_mon -= 1;
  date.tm_isdst = -1;
  seconds = std::mktime(&date);
  return seconds >= 0;
}

/// `1598601600.123456`, or a date.
bool read_time(std::string_view text, std::int64_t& t_ns) {
  constexpr std::int64_t kMostSeconds = 9'000'000'000;  // as nanoseconds they fit in 64 bits
  std::string_view whole;
  std::int64_t seconds = 0, fraction = 0;
  if (!cut(text, '.', whole) || text.size() > 9) return false;
  if (!read_number(text, 10, fraction)) return false;
  if (!read_number(whole, 10, seconds) && !read_date(whole, seconds)) return false;
  if (seconds > kMostSeconds) return false;
  for (std::size_t digits = text.size(); digits < 9; ++digits) fraction *= 10;
  t_ns = seconds * kSecond + fraction;
  return true;
}

bool read_identifier(std::string_view text, CanFrame& frame) {
  if (!read_number(text, 16, frame.id)) return false;
  if (text.size() == 3) return frame.id <= kLargestStandardId;
  if (text.size() != 8) return false;
  frame.is_error = (frame.id & kErrorFlag) != 0;
  frame.is_extended = !frame.is_error;
  frame.id &= ~kErrorFlag;
  return frame.id <= kLargestExtendedId;
}

bool read_data(std::string_view text, std::size_t most, CanFrame& frame) {
  frame.size = 0;
  while (!text.empty()) {
    if (text.front() == '.') text.remove_prefix(1);
    if (text.size() < 2 || frame.size == most) return false;
    if (!read_number(text.substr(0, 2), 16, frame.data[frame.size++])) return false;
    text.remove_prefix(2);
  }
  return true;
}

/// What follows the first #.
bool read_content(std::string_view text, CanFrame& frame) {
  if (text.starts_with('#')) {
    std::uint8_t flags = 0;
    return read_number(text.substr(1, 1), 16, flags) &&
           read_data(text.substr(2), frame.data.size(), frame);
  }
  if (text.starts_with('R')) {
    frame.is_remote = true;
    frame.size = 0;
    return !frame.is_error && (text.size() == 1 || (read_number(text.substr(1), 16, frame.size) &&
                                                    frame.size <= kClassicSize));
  }
  constexpr std::size_t kFull = 2 * kClassicSize;
  if (text.size() == kFull + 2 && text[kFull] == '_') text = text.substr(0, kFull);
  return read_data(text, kClassicSize, frame);
}

void skip_blanks(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
}

/// Cuts off the next word, and the blanks behind it.
std::string_view word(std::string_view& text) {
  const std::string_view found = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(found.size());
  skip_blanks(text);
  return found;
}

/// `1A0#00112233`, and perhaps the direction behind it.
CanLineRefusal read_compact(std::string_view text, CanFrame& frame) {
  std::string_view identifier;
  if (text.ends_with(" R") || text.ends_with(" T")) text.remove_suffix(2);
  if (!cut(text, '#', identifier)) return CanLineRefusal::form;
  if (!read_identifier(identifier, frame)) return CanLineRefusal::identifier;
  return read_content(text, frame) ? CanLineRefusal::none : CanLineRefusal::data;
}

/// `1A0   [4]  00 11 22 33`, perhaps with the direction and two flags before it.
CanLineRefusal read_columns(std::string_view text, CanFrame& frame) {
  std::string_view identifier = word(text);
  if (identifier == "RX" || identifier == "TX") {
    word(text);
    word(text);
    identifier = word(text);
  }
  const std::string_view length = word(text);
  if (!length.starts_with('[') || !length.ends_with(']')) return CanLineRefusal::form;
  if (!read_identifier(identifier, frame)) return CanLineRefusal::identifier;
  std::size_t size = 0;
  if (!read_number(length.substr(1, length.size() - 2), 10, size) || size > frame.data.size()) {
    return CanLineRefusal::data;
  }
  if (text.starts_with("remote request")) {
    frame.is_remote = true;
    frame.size = static_cast<std::uint8_t>(size);
    return size <= kClassicSize && !frame.is_error ? CanLineRefusal::none : CanLineRefusal::data;
  }
  for (std::size_t i = 0; i < size; ++i) {
    const std::string_view byte = word(text);
    if (byte.size() != 2 || !read_number(byte, 16, frame.data[i])) return CanLineRefusal::data;
  }
  frame.size = static_cast<std::uint8_t>(size);
  return CanLineRefusal::none;
}

}  // namespace

CanLineRefusal parse_can_line(std::string_view line, CanFrame& frame, std::string_view& interface) {
  frame = {};
  std::string_view time;
  skip_blanks(line);
  line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
  if (!line.starts_with('(')) return CanLineRefusal::form;
  line.remove_prefix(1);
  if (!cut(line, ')', time) || !line.starts_with(' ')) return CanLineRefusal::form;
  skip_blanks(line);
  interface = word(line);
  if (interface.empty() || line.empty()) return CanLineRefusal::form;
  if (!read_time(time, frame.t_ns)) return CanLineRefusal::time;
  return line.find('#') != std::string_view::npos && line.find('[') == std::string_view::npos
             ? read_compact(line, frame)
             : read_columns(line, frame);
}

std::uint64_t CanLogCounters::all_refused() const {
  return std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
}

bool CanLogCounters::has_differences() const {
  constexpr std::int64_t kNoEpoch = 31'536'000 * kSecond;  // a year
  constexpr std::uint64_t kTells = 8;
  return frames > kTells && not_later > frames / 4 && latest_ns < kNoEpoch;
}

Result<CanLogReader> CanLogReader::open(const std::filesystem::path& file) {
  CanLogReader reader;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored)) reader.stream_.open(file, std::ios::binary);
  if (!reader.stream_.is_open()) return fail(fmt::format("cannot read {}", file.string()));
  if (const std::string_view packer = packed_with(file); !packer.empty()) {
    return fail(fmt::format("{}: is packed with {}: unpack it first", file.string(), packer));
  }
  if (const int first = reader.stream_.peek(); first == 0xFF || first == 0xFE) {
    return fail(file.string() + ": is text of 16 bits a character (UTF-16): save it as UTF-8");
  }
  return reader;
}

bool CanLogReader::next(CanFrame& frame, std::string* interface) {
  while (stream_) {
    stream_.getline(line_.data(), static_cast<std::streamsize>(line_.size()));
    auto length = static_cast<std::size_t>(stream_.gcount());
    position_ += length;
    if (stream_.eof() && length == 0) return false;
    if (stream_.fail() && !stream_.eof()) {
      if (stream_.bad()) return false;
      stream_.clear();
      stream_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
      ++counters_.refused[static_cast<std::size_t>(CanLineRefusal::form)];
      continue;
    }
    if (!stream_.eof()) --length;  // the line's end is counted
    std::string_view line(line_.data(), length);
    if (std::exchange(is_first_, false) && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
    }
    if (line.empty() || line == "\r" || line.starts_with('#')) continue;
    std::string_view name;
    const CanLineRefusal refusal = parse_can_line(line, frame, name);
    if (refusal == CanLineRefusal::none) {
      if (counters_.frames++ > 0 && frame.t_ns <= last_ns_) ++counters_.not_later;
      last_ns_ = frame.t_ns;
      counters_.latest_ns = std::max(counters_.latest_ns, frame.t_ns);
      if (interface != nullptr) *interface = name;
      return true;
    }
    ++counters_.refused[static_cast<std::size_t>(refusal)];
  }
  return false;
}

Result<CanLogWriter> CanLogWriter::create(const std::filesystem::path& file) {
  CanLogWriter writer;
  writer.name_ = file.string();
  writer.stream_.open(file, std::ios::binary);
  if (!writer.stream_) return fail(fmt::format("cannot write {}", file.string()));
  return writer;
}

void CanLogWriter::write(const CanFrame& frame, std::string_view interface) {
  fmt::memory_buffer line;
  const auto out = std::back_inserter(line);
  fmt::format_to(out, "({:010}.{:06}) {} ", frame.t_ns / kSecond, frame.t_ns % kSecond / 1000,
                 interface);
  if (frame.is_error || frame.is_extended) {
    fmt::format_to(out, "{:08X}#", frame.id | (frame.is_error ? kErrorFlag : 0));
  } else {
    fmt::format_to(out, "{:03X}#", frame.id);
  }
  if (frame.is_remote) {
    fmt::format_to(out, "R");
    if (frame.size > 0) fmt::format_to(out, "{:X}", frame.size);
  } else if (frame.size > kClassicSize) {
    fmt::format_to(out, "#0");
  }
  for (const std::uint8_t byte : frame.payload()) fmt::format_to(out, "{:02X}", byte);
  line.push_back('\n');
  stream_.write(line.data(), static_cast<std::streamsize>(line.size()));
}

Result<void> CanLogWriter::flush() {
  stream_.flush();
  return result();
}

Result<void> CanLogWriter::close() {
  stream_.close();
  return result();
}

Result<void> CanLogWriter::result() const {
  if (!stream_) return fail(fmt::format("cannot write {}: the disk may be full", name_));
  if (!std::filesystem::exists(name_)) return fail(name_ + " is gone: was its folder removed?");
  return {};
}

}  // namespace scree
