#include "scree/capture/pcap_reader.hpp"

#include <pcap/pcap.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "fragments.hpp"
#include "pcapng_file.hpp"
#include "scree/capture/capture.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {

void PcapReader::Close::operator()(pcap* handle) const {
  pcap_close(handle);
}

PcapReader::PcapReader(std::string name, std::unique_ptr<pcap, Close> handle,
                       std::unique_ptr<PcapngFile> pcapng)
    : name_(std::move(name)),
      handle_(std::move(handle)),
      pcapng_(std::move(pcapng)),
      fragments_(std::make_unique<Fragments>()),
      link_type_(pcapng_ ? pcapng_->link_type() : pcap_datalink(handle_.get())) {}

PcapReader::PcapReader(PcapReader&&) noexcept = default;
PcapReader& PcapReader::operator=(PcapReader&&) noexcept = default;
PcapReader::~PcapReader() = default;

Result<PcapReader> PcapReader::open(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) return fail(fmt::format("{}: no such file", file.string()));
  if (!std::filesystem::is_regular_file(status)) {
    return fail(fmt::format("{}: is no regular file: copy it into one", file.string()));
  }
  if (std::filesystem::file_size(file, error) == 0) {
    return fail(fmt::format("{}: the file is empty", file.string()));
  }
  if (const std::string_view packer = packed_with(file); !packer.empty()) {
    return fail(fmt::format("{}: is packed with {}: unpack it first", file.string(), packer));
  }
  if (is_pcapng(file)) {
    PcapReader reader(file.string(), nullptr, std::make_unique<PcapngFile>(file));
    if (reader.link_type() >= 0) return reader;
    const std::string& fault = reader.pcapng_->fault();
    return fail(fault.empty() ? reader.name_ + ": describes no interface, and so holds no packet"
                              : reader.name_ + ": breaks off before its first packet: " + fault);
  }
  std::array<char, PCAP_ERRBUF_SIZE> reason{};
  std::unique_ptr<pcap, Close> handle(pcap_open_offline_with_tstamp_precision(
      file.c_str(), PCAP_TSTAMP_PRECISION_NANO, reason.data()));
  if (!handle) {
    const std::string kind = other_kind(file);
    return fail(fmt::format("{}: cannot be read as a pcap or pcapng file ({})", file.string(),
                            kind.empty() ? reason.data() : kind));
  }
  return PcapReader(file.string(), std::move(handle), nullptr);
}

std::uint64_t PcapReader::position() const {
  return pcapng_ ? pcapng_->position()
                 : static_cast<std::uint64_t>(std::max(ftell(pcap_file(handle_.get())), 0L));
}

void PcapReader::break_off(std::string_view why) {
  std::error_code ignored;
  const std::uint64_t size = std::filesystem::file_size(name_, ignored);
  broken_off_ = fmt::format("{}: breaks off: {}", name_, why);
  if (const std::uint64_t read = position(); read < size) {
    broken_off_ += fmt::format("; the last {} of its {} bytes are not read", size - read, size);
  }
}

bool PcapReader::next_of_pcapng(PcapRecord& record) {
  if (pcapng_->next(record)) return true;
  if (!pcapng_->fault().empty()) {
    break_off(pcapng_->fault());
  }
  return false;
}

bool PcapReader::next(PcapRecord& record) {
  if (pcapng_) return next_of_pcapng(record);
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  const int result = pcap_next_ex(handle_.get(), &header, &bytes);
  if (result != 1) {
    if (result == PCAP_ERROR) {
      break_off(pcap_geterr(handle_.get()));
    }
    return false;
  }
  // The file's 32 bits have no sign (draft-ietf-opsawg-pcap, section 5); libpcap gives them one,
  // which would be before 1970 from 2038 on. With nanosecond precision tv_usec holds nanoseconds.
  const std::int64_t seconds = static_cast<std::uint32_t>(header->ts.tv_sec);
  const std::int64_t nanoseconds = header->ts.tv_usec;
  if (nanoseconds < 0 || nanoseconds >= kSecond) {
    break_off("a record has an impossible time");
    return false;
  }
  record.arrival_ns = seconds * kSecond + nanoseconds;
  record.bytes = {bytes, header->caplen};
  record.original_size = header->len;
  record.link_type = link_type_;
  return true;
}

/// Takes a fragment; udp where its datagram is whole with it.
FrameKind PcapReader::join(const PcapRecord& record, Datagram& datagram) {
  ++frames_.fragments;
  const auto packet = ipv4_packet(record.link_type, record.bytes);
  const auto whole = packet ? fragments_->take(*packet) : std::nullopt;
  if (!whole) return FrameKind::fragment;
  frames_.fragments -= whole->fragments;
  return parse_frame(DLT_RAW, whole->packet, whole->packet.size(), datagram);
}

bool PcapReader::next(Datagram& datagram) {
  PcapRecord record;
  while (next(record)) {
    FrameKind kind = parse_frame(record.link_type, record.bytes, record.original_size, datagram);
    if (kind == FrameKind::fragment) kind = join(record, datagram);
    switch (kind) {
      case FrameKind::udp:
        ++frames_.udp;
        datagram.arrival_ns = record.arrival_ns;
        return true;
      case FrameKind::other:
        ++frames_.other;
        break;
      case FrameKind::fragment:
        break;  // counted already
      case FrameKind::truncated:
        ++frames_.truncated;
        break;
    }
  }
  return false;
}

}  // namespace scree
