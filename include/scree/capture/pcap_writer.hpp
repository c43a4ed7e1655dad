#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scree/capture/datagram.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/core/result.hpp"

struct pcap;
struct pcap_dumper;

namespace scree {

/// Writes a pcap file with nanosecond times, as every capture of ours has them.
class PcapWriter {
public:
  /// Ethernet frames, for lidar.pcap.
  static Result<PcapWriter> create_ethernet(const std::filesystem::path& file);
  /// A serial stream (DLT_USER0), for imu.pcap: one record for each read from the port.
  static Result<PcapWriter> create_serial(const std::filesystem::path& file);

  /// For records that are copied from another file.
  static Result<PcapWriter> create_like(const std::filesystem::path& file, const PcapReader& other);

  /// As a broadcast frame from the datagram's source, with right checksums: what tcpdump captures
  /// of a VLP-16. @pre created as Ethernet, payload of at most 65,507 bytes
  void write(const Datagram& datagram);
  /// @pre created as a serial stream
  void write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes);
  /// A record as it was captured. @pre of a file with the same link type
  void write(const PcapRecord& record);

  /// Writes out what is buffered: the file is whole from here on, whatever happens. An error (a
  /// full disk, a file that was removed) shows itself here or in close().
  Result<void> flush();
  Result<void> close();

private:
  struct Close {
    void operator()(pcap* handle) const;
    void operator()(pcap_dumper* dumper) const;
  };

  static Result<PcapWriter> create(const std::filesystem::path& file, int link_type);

  std::string name_;
  std::unique_ptr<pcap, Close> handle_;
  std::unique_ptr<pcap_dumper, Close> dumper_;
  std::vector<std::uint8_t> frame_;
};

}  // namespace scree
