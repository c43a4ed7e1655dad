#include "scree/capture/pcap_writer.hpp"

#include <pcap/pcap.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::size_t kEthernetHeader = 14, kIpHeader = 20;
constexpr std::size_t kHeaders = kEthernetHeader + kIpHeader + kUdpHeader;
constexpr int kSnapLength = 262144;  // the default of tcpdump

/// The Internet checksum (RFC 1071): the ones' complement of the ones' complement sum of 16-bit
/// words, begun with `sum`.
std::uint16_t internet_checksum(std::span<const std::uint8_t> bytes, std::uint32_t sum = 0) {
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    sum += static_cast<std::uint32_t>(bytes[i] << 8);
    if (i + 1 < bytes.size()) sum += bytes[i + 1];
  }
  while (sum >> 16 != 0) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

void put_u16(std::span<std::uint8_t> bytes, std::size_t offset, std::size_t value) {
  bytes[offset] = static_cast<std::uint8_t>(value >> 8);
  bytes[offset + 1] = static_cast<std::uint8_t>(value);
}

void write_headers(const Datagram& datagram, std::span<std::uint8_t> frame) {
  std::fill_n(frame.begin(), kHeaders, std::uint8_t{0});
  // Broadcast, from Velodyne's range of hardware addresses.
  constexpr std::array<std::uint8_t, 12> kHardware = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,
                                                      0x60, 0x76, 0x88, 0x00, 0x00, 0x01};
  std::copy(kHardware.begin(), kHardware.end(), frame.begin());
  put_u16(frame, 12, 0x0800);

  const auto ip = frame.subspan(kEthernetHeader);
  ip[0] = 0x45;
  put_u16(ip, 2, ip.size());
  ip[6] = 0x40;  // do not fragment
  ip[8] = 64;    // time to live
  ip[9] = 17;    // UDP
  put_u16(ip, 12, datagram.source >> 16);
  put_u16(ip, 14, datagram.source & 0xFFFF);
  put_u16(ip, 16, 0xFFFF);
  put_u16(ip, 18, 0xFFFF);
  put_u16(ip, 10, internet_checksum(ip.first(kIpHeader)));

  const auto udp = ip.subspan(kIpHeader);
  put_u16(udp, 0, datagram.source_port);
  put_u16(udp, 2, datagram.destination_port);
  put_u16(udp, 4, udp.size());
  // The checksum covers the addresses, the protocol and the length too (RFC 768). 0 means "none".
  const std::uint32_t pseudo_header = (datagram.source >> 16) + (datagram.source & 0xFFFF) +
                                      2 * 0xFFFFU + 17 + static_cast<std::uint32_t>(udp.size());
  const std::uint16_t checksum = internet_checksum(udp, pseudo_header);
  put_u16(udp, 6, checksum == 0 ? 0xFFFF : checksum);
}

void dump(pcap_dumper* dumper, const PcapRecord& record) {
  pcap_pkthdr header{};
  header.ts.tv_sec = record.arrival_ns / kSecond;
  header.ts.tv_usec = record.arrival_ns % kSecond;  // nanoseconds, by the file's precision
  header.caplen = static_cast<bpf_u_int32>(record.bytes.size());
  header.len = static_cast<bpf_u_int32>(record.original_size);
  // libpcap's callback type makes the file handle look like a string of bytes.
  pcap_dump(reinterpret_cast<u_char*>(dumper), &header, record.bytes.data());
}

}  // namespace

void PcapWriter::Close::operator()(pcap* handle) const {
  pcap_close(handle);
}
void PcapWriter::Close::operator()(pcap_dumper* dumper) const {
  pcap_dump_close(dumper);
}

Result<PcapWriter> PcapWriter::create(const std::filesystem::path& file, int link_type) {
  PcapWriter writer;
  writer.name_ = file.string();
  writer.handle_.reset(
      pcap_open_dead_with_tstamp_precision(link_type, kSnapLength, PCAP_TSTAMP_PRECISION_NANO));
  writer.dumper_.reset(pcap_dump_open(writer.handle_.get(), file.c_str()));
  if (!writer.dumper_) {
    return fail(
        fmt::format("cannot write {}: {}", file.string(), pcap_geterr(writer.handle_.get())));
  }
  // A file without the format's head would be none.
  if (const auto flushed = writer.flush(); !flushed) return tl::make_unexpected(flushed.error());
  return writer;
}

Result<PcapWriter> PcapWriter::create_ethernet(const std::filesystem::path& file) {
  return create(file, DLT_EN10MB);
}

Result<PcapWriter> PcapWriter::create_serial(const std::filesystem::path& file) {
  return create(file, DLT_USER0);
}

Result<PcapWriter> PcapWriter::create_like(const std::filesystem::path& file,
                                           const PcapReader& other) {
  return create(file, other.link_type());
}

void PcapWriter::write(const Datagram& datagram) {
  frame_.resize(kHeaders + datagram.payload.size());
  std::copy(datagram.payload.begin(), datagram.payload.end(), frame_.begin() + kHeaders);
  write_headers(datagram, frame_);
  write(datagram.arrival_ns, frame_);
}

void PcapWriter::write(std::int64_t arrival_ns, std::span<const std::uint8_t> bytes) {
  dump(dumper_.get(), {arrival_ns, bytes, bytes.size()});
}

void PcapWriter::write(const PcapRecord& record) {
  dump(dumper_.get(), record);
}

Result<void> PcapWriter::flush() {
  std::FILE* const stream = pcap_dump_file(dumper_.get());
  if (pcap_dump_flush(dumper_.get()) != 0 || std::ferror(stream) != 0) {
    return fail(fmt::format("cannot write {}: the disk may be full", name_));
  }
  if (!std::filesystem::exists(name_)) return fail(name_ + " is gone: was its folder removed?");
  return {};
}

Result<void> PcapWriter::close() {
  auto flushed = flush();
  dumper_.reset();
  return flushed;
}

}  // namespace scree
