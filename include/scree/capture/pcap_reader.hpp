#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "scree/capture/datagram.hpp"
#include "scree/core/result.hpp"

struct pcap;

namespace scree {

/// A record of a capture file. The bytes lie in the reader's memory until its next read.
struct PcapRecord {
  std::int64_t arrival_ns = 0;
  std::span<const std::uint8_t> bytes;
  std::size_t original_size = 0;  ///< on the wire; `bytes` may be a part
  int link_type = 0;              ///< DLT_*: in pcapng each interface has its own
};

struct FrameCounters {
  std::uint64_t udp = 0, other = 0, truncated = 0;
  std::uint64_t fragments = 0;  ///< of datagrams of which parts are missing
};

class Fragments;
class PcapngFile;

/// Whether a file begins as pcapng does.
bool is_pcapng(const std::filesystem::path& file);

/// Reads a pcap or pcapng file, of microseconds or nanoseconds, in either byte order; fragmented
/// datagrams are put together. Any bytes are safe: a file cut or garbled in the middle gives
/// everything before, and then a reason.
class PcapReader {
public:
  /// One sentence when there is no such file, or it is empty, or it is no capture file.
  static Result<PcapReader> open(const std::filesystem::path& file);

  PcapReader(PcapReader&&) noexcept;
  PcapReader& operator=(PcapReader&&) noexcept;
  ~PcapReader();

  /// DLT_*; 147 (DLT_USER0) is a serial stream. Of a pcapng file that of one of its interfaces.
  int link_type() const { return link_type_; }

  /// False at the end.
  bool next(PcapRecord& record);
  /// Skips and counts what is no UDP datagram. False at the end.
  bool next(Datagram& datagram);

  /// How many bytes of the file were read, about.
  std::uint64_t position() const;
  /// Why the file ended before its end; empty if it did not.
  const std::string& broken_off() const { return broken_off_; }
  /// What the calls of next(Datagram&) have seen.
  const FrameCounters& frames() const { return frames_; }

private:
  void break_off(std::string_view why);
  struct Close {
    void operator()(pcap* handle) const;
  };

  PcapReader(std::string name, std::unique_ptr<pcap, Close> handle,
             std::unique_ptr<PcapngFile> pcapng);

  bool next_of_pcapng(PcapRecord& record);
  FrameKind join(const PcapRecord& record, Datagram& datagram);

  std::string name_;
  std::unique_ptr<pcap, Close> handle_;  // one of these two
  std::unique_ptr<PcapngFile> pcapng_;
  std::unique_ptr<Fragments> fragments_;
  int link_type_;
  std::string broken_off_;
  FrameCounters frames_;
};

}  // namespace scree
