#include "pcd_body.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace scree {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Unpacks LZF, as liblzf writes it. A byte under 32 says how many follow as they are, less one.
/// Any other says how many to copy (3 bits, and a byte more where these are full; less two) from
/// how far back (5 bits and the next byte; less one). False where that does not fill `unpacked`.
bool unpack_lzf(std::span<const std::uint8_t> packed, std::span<std::uint8_t> unpacked) {
  std::size_t in = 0, out = 0;
  while (in < packed.size()) {
    const std::size_t control = packed[in++];
    const bool is_copy = control >= 32;
    std::size_t length = is_copy ? (control >> 5U) + 2 : control + 1;
    if (is_copy && control >> 5U == 7 && in < packed.size()) length += packed[in++];
    if (in >= packed.size() || length > unpacked.size() - out) return false;
    if (is_copy) {
      const std::size_t back = ((control & 31U) << 8U) + packed[in++] + 1;
      if (back > out) return false;
      // Byte by byte: the copy may reach into what it writes.
      for (; length > 0; --length, ++out) unpacked[out] = unpacked[out - back];
    } else {
      if (length > packed.size() - in) return false;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), length,
                  unpacked.begin() + static_cast<std::ptrdiff_t>(out));
      in += length;
      out += length;
    }
  }
  return out == unpacked.size();
}

/// Where compressed, all values of a field stand together, then those of the next.
Bytes interleaved(const Bytes& columns, const PcdHeader& header) {
  Bytes points(columns.size());
  const std::uint8_t* from = columns.data();
  for (const PcdField& field : header.fields) {
    const std::size_t size = field.size * field.count;
    for (std::size_t i = 0; i < header.points; ++i, from += size) {
      std::memcpy(points.data() + i * header.point_size + field.offset, from, size);
    }
  }
  return points;
}

Result<Bytes> unpacked(std::string_view body, const PcdHeader& header) {
  constexpr std::size_t kSizes = 8;  // both lengths; the header was checked against them
  std::uint32_t packed = 0;
  std::memcpy(&packed, body.data(), sizeof packed);
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(body.data()) + kSizes;
  Bytes columns(header.points * header.point_size);
  if (!unpack_lzf({bytes, packed}, columns)) {
    // What would not become smaller is left as it is by pypcd4.
    if (packed != columns.size()) return fail("has points that cannot be read");
    std::copy_n(bytes, packed, columns.begin());
  }
  return interleaved(columns, header);
}

/// What is too large or too small is rounded as the C library does. Nothing: no number.
template <class Real>
std::optional<Real> real_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  Real value = 0;
  const auto read = std::from_chars(word.data(), end, value);
  if (read.ec == std::errc::invalid_argument) return std::nullopt;
  // As Microsoft's C library wrote what is no number: 1.#QNAN, -1.#IND, 1.#INF.
  if (read.ptr != end && *read.ptr == '#') return std::numeric_limits<Real>::quiet_NaN();
  if (read.ptr != end) return std::nullopt;
  if (read.ec != std::errc::result_out_of_range) return value;
  return static_cast<Real>(std::strtold(std::string(word).c_str(), nullptr));
}

/// A negative number wraps in an unsigned field, and a fraction is cut off. Nothing: no number.
std::optional<std::uint64_t> whole_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto is_all = [end](const std::from_chars_result& read) {
    return read.ec == std::errc{} && read.ptr == end;
  };
  std::int64_t negative = 0;
  std::uint64_t value = 0;
  if (is_all(std::from_chars(word.data(), end, negative))) {
    return static_cast<std::uint64_t>(negative);
  }
  if (is_all(std::from_chars(word.data(), end, value))) return value;
  constexpr double kLargest = 9e18;
  const auto real = real_of<double>(word);
  if (!real) return std::nullopt;
  return std::abs(*real) < kLargest ? static_cast<std::uint64_t>(static_cast<std::int64_t>(*real))
                                    : 0;
}

template <class T>
bool store(const std::optional<T>& value, std::size_t size, std::uint8_t* bytes) {
  // Little-endian, as all of PCD: the low bytes come first.
  if (value) std::memcpy(bytes, &*value, size);
  return value.has_value();
}

/// False where the word is no number.
bool store_word(std::string_view word, const PcdField& field, std::uint8_t* bytes) {
  if (field.type != 'F') return store(whole_of(word), field.size, bytes);
  return field.size == 4 ? store(real_of<float>(word), field.size, bytes)
                         : store(real_of<double>(word), field.size, bytes);
}

/// The next word of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kSpace = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kSpace), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kSpace));
  line.remove_prefix(word.size());
  return word;
}

/// What is wrong with a line; empty: nothing. Padding at its end may be missing.
std::string store_line(std::string_view line, const PcdHeader& header, std::uint8_t* point) {
  for (const PcdField& field : header.fields) {
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string_view word = next_word(line);
      if (field.name == kPadding) continue;
      if (word.empty()) return "too few values";
      if (!store_word(word, field, point + field.offset + i * field.size)) {
        constexpr std::size_t kShown = 30;
        return fmt::format("'{}', which is no number,", word.substr(0, kShown));
      }
    }
  }
  return "";
}

std::size_t lines_with_words(std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!next_word(line).empty()) ++count;
  }
  return count;
}

Result<Bytes> parsed(std::string_view text, const PcdHeader& header) {
  Bytes points(header.points * header.point_size);
  std::size_t count = 0;
  while (count < header.points && !text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (std::string_view rest = line; next_word(rest).empty()) continue;
    const std::string wrong = store_line(line, header, points.data() + count * header.point_size);
    if (!wrong.empty()) return fail(fmt::format("has {} for point {}", wrong, count + 1));
    ++count;
  }
  const std::size_t more = lines_with_words(text);
  if (more > 0) return fail(too_many(more));
  if (count == header.points) return points;
  return fail(fmt::format("is cut: {} of {} points are there", count, header.points));
}

}  // namespace

Result<Bytes> read_pcd_body(std::string_view file, const PcdHeader& header) {
  const std::string_view body = file.substr(header.body);
  switch (header.data) {
    case PcdData::ascii:
      return parsed(body, header);
    case PcdData::binary_compressed:
      return unpacked(body, header);
    case PcdData::binary:
      break;
  }
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(body.data());
  return Bytes(bytes, bytes + header.points * header.point_size);
}

}  // namespace scree
