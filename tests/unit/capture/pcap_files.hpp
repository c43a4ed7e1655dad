#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scree/capture/pcap_reader.hpp"
#include "scree/capture/pcap_writer.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {

/// What a capture holds.
struct Read {
  std::vector<std::int64_t> arrival_ns;
  std::vector<std::vector<std::uint8_t>> payloads;
  FrameCounters frames;
  std::string broken_off, error;
};

inline Read read_all(const std::filesystem::path& file) {
  Read read;
  auto reader = PcapReader::open(file);
  if (!reader) {
    read.error = reader.error().message;
    return read;
  }
  Datagram datagram;
  while (reader->next(datagram)) {
    read.arrival_ns.push_back(datagram.arrival_ns);
    read.payloads.emplace_back(datagram.payload.begin(), datagram.payload.end());
  }
  read.frames = reader->frames();
  read.broken_off = reader->broken_off();
  return read;
}

/// Datagrams of a lidar, 1 ns apart; the payload of each is one byte longer than the one before.
inline void write_packets(const std::filesystem::path& file, int count,
                          std::int64_t begin_ns = 1'598'612'523'000'000'001) {
  auto writer = PcapWriter::create_ethernet(file);
  ASSERT_TRUE(writer) << writer.error().message;
  for (int i = 0; i < count; ++i) {
    const std::vector<std::uint8_t> payload(static_cast<std::size_t>(1206 + i),
                                            static_cast<std::uint8_t>(i));
    writer->write(Datagram{begin_ns + i, 0xC0A801C9, 2368, 2368, payload});
  }
  ASSERT_TRUE(writer->close());
}

/// Appends the low `size` bytes of a number.
inline void append(std::string& bytes, std::uint64_t value, int size, bool big_endian) {
  for (int i = 0; i < size; ++i) {
    bytes.push_back(static_cast<char>(value >> 8 * (big_endian ? size - 1 - i : i)));
  }
}

/// A pcapng file of little-endian blocks.
class PcapngText {
public:
  PcapngText() {
    std::string section;
    append(section, 0x1A2B3C4D, 4, false), append(section, 1, 4, false);
    append(section, ~std::uint64_t{0}, 8, false);
    block(0x0A0D0D0A, section);
  }
  /// @param resolution as the option if_tsresol says it
  void interface(int link_type, int snap_length, int resolution) {
    std::string body;
    append(body, static_cast<std::uint64_t>(link_type), 4, false);
    append(body, static_cast<std::uint64_t>(snap_length), 4, false);
    append(body, 9, 2, false), append(body, 1, 2, false);
    append(body, static_cast<std::uint64_t>(resolution), 4, false), append(body, 0, 4, false);
    block(1, body);
  }
  void packet(std::uint32_t interface, std::uint64_t time, const std::string& frame) {
    std::string body;
    append(body, interface, 4, false);
    append(body, time >> 32, 4, false), append(body, time & 0xFFFFFFFF, 4, false);
    append(body, frame.size(), 4, false), append(body, frame.size(), 4, false);
    body += frame;
    body.resize((body.size() + 3) / 4 * 4);
    block(6, body);
  }
  void simple_packet(const std::string& frame) {
    std::string body;
    append(body, frame.size(), 4, false);
    body += frame;
    body.resize((body.size() + 3) / 4 * 4);
    block(3, body);
  }
  void block(std::uint32_t type, const std::string& body) {
    append(bytes, type, 4, false), append(bytes, body.size() + 12, 4, false);
    bytes += body;
    append(bytes, body.size() + 12, 4, false);
  }

  std::string bytes;
};

/// Ethernet, IPv4 and UDP with a packet of a lidar.
inline std::string frame_of_a_packet(const TemporaryFolder& folder) {
  write_packets(folder / "one.pcap", 1);
  return bytes_of(folder / "one.pcap").substr(24 + 16);
}

}  // namespace scree
