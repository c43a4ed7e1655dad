#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scree/capture/pcap_reader.hpp"

namespace scree {

/// Reads a pcapng file (IETF draft-ietf-opsawg-pcapng) with any number of sections and interfaces,
/// each with a link type, a snap length and a clock of its own: libpcap refuses a second one that
/// differs. Any bytes are safe, and a block takes no more memory than kLongestBlock.
class PcapngFile {
public:
  explicit PcapngFile(const std::filesystem::path& file);

  /// False at the end, and where the file breaks off.
  bool next(PcapRecord& record);
  /// How many bytes were read.
  std::uint64_t position() const { return position_; }
  /// Why it breaks off; empty where it has not.
  const std::string& fault() const { return fault_; }

  /// DLT_* of the first interface whose packets can hold UDP, else of the first one; -1: of none.
  /// Looked for until the first packet.
  int link_type();

private:
  static constexpr std::uint32_t kLongestBlock = 16 << 20;

  struct Interface {
    int link_type = 0;
    std::uint32_t snap_length = 0;  ///< bytes; 0: no limit
    bool is_binary = false;         ///< whether a second has 2^digits units, else 10^digits
    int digits = 6;
    std::int64_t offset_s = 0;
  };

  bool read_block();
  bool break_off(std::string reason);
  std::uint32_t u32(std::size_t offset) const { return number(offset, 4); }
  std::uint16_t u16(std::size_t offset) const {
    return static_cast<std::uint16_t>(number(offset, 2));
  }
  std::uint32_t number(std::size_t offset, std::size_t size) const;
  void add_interface();
  bool take_packet(PcapRecord& record);
  std::optional<std::int64_t> time_ns(const Interface& interface, std::uint64_t units) const;

  std::ifstream stream_;
  std::uint64_t position_ = 0;
  std::string fault_;
  bool is_big_endian_ = false;
  std::uint32_t type_ = 0;          // of the block that was read last
  std::vector<std::uint8_t> body_;  // of it
  bool is_packet_waiting_ = false;  // it is the first packet, seen by link_type()
  std::vector<Interface> interfaces_;
};

}  // namespace scree
