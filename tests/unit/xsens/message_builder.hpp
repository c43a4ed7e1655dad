#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <vector>

// Writes Xbus messages by the documentation alone (MT0101P): the other side of the decoder, which
// shares no code with it.
namespace scree::test {

using ByteVector = std::vector<std::uint8_t>;

inline void put_unsigned(ByteVector& bytes, std::uint64_t value, int size) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// @param format 0 float, 1 fixed 12.20, 2 fixed 16.32, 3 double
inline void put_real(ByteVector& bytes, double value, int format) {
  switch (format) {
    case 0: {
      const auto number = static_cast<float>(value);
      std::uint32_t bits = 0;
      std::memcpy(&bits, &number, sizeof bits);
      return put_unsigned(bytes, bits, 4);
    }
    case 1:
      return put_unsigned(bytes, static_cast<std::uint64_t>(std::llround(value * 1048576.0)), 4);
    case 2: {
      const auto scaled = static_cast<std::uint64_t>(std::llround(value * 4294967296.0));
      put_unsigned(bytes, scaled, 4);
      return put_unsigned(bytes, scaled >> 32, 2);
    }
    default: {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof bits);
      return put_unsigned(bytes, bits, 8);
    }
  }
}

inline ByteVector item(unsigned id, const ByteVector& data) {
  ByteVector bytes;
  put_unsigned(bytes, id, 2);
  put_unsigned(bytes, data.size(), 1);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

/// The lowest two bits of the id are the format.
inline ByteVector reals(unsigned id, std::initializer_list<double> values) {
  ByteVector data;
  for (const double value : values) put_real(data, value, static_cast<int>(id & 3U));
  return item(id, data);
}

inline ByteVector integer(unsigned id, std::uint64_t value, int size) {
  ByteVector data;
  put_unsigned(data, value, size);
  return item(id, data);
}

inline ByteVector joined(std::initializer_list<ByteVector> parts) {
  ByteVector bytes;
  for (const ByteVector& part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

inline ByteVector message(unsigned id, const ByteVector& data, bool force_extended = false) {
  ByteVector bytes{0xFA, 0xFF, static_cast<std::uint8_t>(id)};
  if (data.size() > 254 || force_extended) {
    bytes.push_back(0xFF);
    put_unsigned(bytes, data.size(), 2);
  } else {
    put_unsigned(bytes, data.size(), 1);
  }
  bytes.insert(bytes.end(), data.begin(), data.end());
  std::uint8_t sum = 0;
  for (std::size_t i = 1; i < bytes.size(); ++i) sum = static_cast<std::uint8_t>(sum + bytes[i]);
  bytes.push_back(static_cast<std::uint8_t>(-sum));
  return bytes;
}

/// An MTData2 message.
inline ByteVector data_message(std::initializer_list<ByteVector> items) {
  return message(0x36, joined(items));
}

}  // namespace scree::test
