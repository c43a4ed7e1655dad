#include "pcapng_file.hpp"

#include <pcap/dlt.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kOldPacket = 2, kSimplePacket = 3,
                        kEnhancedPacket = 6;
constexpr std::uint32_t kByteOrder = 0x1A2B3C4D;
constexpr std::size_t kBlockHeader = 8, kBlockEnd = 4;

bool is_packet(std::uint32_t type) {
  return type == kOldPacket || type == kSimplePacket || type == kEnhancedPacket;
}

std::uint64_t power_of_ten(int digits) {
  std::uint64_t power = 1;
  for (int i = 0; i < digits; ++i) power *= 10;
  return power;
}

}  // namespace

PcapngFile::PcapngFile(const std::filesystem::path& file) : stream_(file, std::ios::binary) {}

bool is_pcapng(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 4> head{};
  return stream.read(head.data(), head.size()) && std::string_view(head.data(), 4) == "\n\r\r\n";
}

std::uint32_t PcapngFile::number(std::size_t offset, std::size_t size) const {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = value << 8U | body_[is_big_endian_ ? offset + i : offset + size - 1 - i];
  }
  return value;
}

bool PcapngFile::break_off(std::string reason) {
  fault_ = std::move(reason);
  return false;
}

/// Reads the next block into body_, with its type and length in front.
bool PcapngFile::read_block() {
  const auto read = [this](std::size_t size) {
    const std::size_t begin = body_.size();
    body_.resize(begin + size);
    stream_.read(reinterpret_cast<char*>(body_.data() + begin), static_cast<std::streamsize>(size));
    const auto got = static_cast<std::size_t>(stream_.gcount());
    position_ += got;
    return got;
  };
  body_.clear();
  const std::size_t got = read(kBlockHeader + 4);
  if (got == 0) return false;
  if (got < kBlockHeader + 4) return break_off("a block is cut");
  type_ = u32(0);  // a section's reads the same in both byte orders
  if (type_ == kSection) {
    is_big_endian_ = false;
    if (u32(kBlockHeader) != kByteOrder) is_big_endian_ = true;
    if (u32(kBlockHeader) != kByteOrder) return break_off("a section has no byte order");
    interfaces_.clear();
  }
  const std::uint32_t length = u32(4);
  if (length % 4 != 0 || length < body_.size() || length > kLongestBlock) {
    return break_off(fmt::format("a block has the impossible length {}", length));
  }
  const std::size_t rest = length - body_.size();
  if (read(rest) != rest) return break_off("a block is cut");
  if (u32(length - kBlockEnd) != length) return break_off("a block has two lengths");
  body_.resize(length - kBlockEnd);
  return true;
}

/// Link type and snap length, and of the options the clock's.
void PcapngFile::add_interface() {
  constexpr std::size_t kOptions = kBlockHeader + 8;
  constexpr std::uint16_t kResolution = 9, kOffset = 14;
  constexpr int kRawInFiles = 101;  // LINKTYPE_RAW
  Interface interface;
  if (body_.size() >= kOptions) {
    // libpcap's numbers are those of the file, but for one.
    const int type = u16(kBlockHeader);
    interface.link_type = type == kRawInFiles ? DLT_RAW : type;
    interface.snap_length = u32(kBlockHeader + 4);
  }
  for (std::size_t at = kOptions; at + 4 <= body_.size();) {
    const std::uint16_t code = u16(at), length = u16(at + 2);
    at += 4;
    if (code == 0 || at + length > body_.size()) break;
    if (code == kResolution && length == 1) {
      interface.is_binary = (body_[at] & 0x80U) != 0;
      interface.digits = body_[at] & 0x7F;
    } else if (code == kOffset && length == 8) {
      const std::uint64_t high = u32(is_big_endian_ ? at : at + 4),
                          low = u32(is_big_endian_ ? at + 4 : at);
      interface.offset_s = static_cast<std::int64_t>(high << 32U | low);
    }
    at += (length + std::size_t{3}) / 4 * 4;
  }
  interfaces_.push_back(interface);
}

int PcapngFile::link_type() {
  while (!is_packet_waiting_ && read_block()) {
    if (type_ == kInterface) add_interface();
    is_packet_waiting_ = is_packet(type_);
  }
  const auto network = std::ranges::find_if(
      interfaces_, [](const Interface& interface) { return is_network_link(interface.link_type); });
  if (network != interfaces_.end()) return network->link_type;
  return interfaces_.empty() ? -1 : interfaces_.front().link_type;
}

bool PcapngFile::next(PcapRecord& record) {
  if (!fault_.empty()) return false;
  while (is_packet_waiting_ || read_block()) {
    is_packet_waiting_ = false;
    if (type_ == kInterface) add_interface();
    if (is_packet(type_)) return take_packet(record);
  }
  return false;
}

bool PcapngFile::take_packet(PcapRecord& record) {
  constexpr std::size_t kFullHeader = kBlockHeader + 20, kSimpleHeader = kBlockHeader + 4;
  const std::size_t header = type_ == kSimplePacket ? kSimpleHeader : kFullHeader;
  if (body_.size() < header) return break_off("a packet is too short");
  const std::size_t number = type_ == kSimplePacket     ? 0
                             : type_ == kEnhancedPacket ? u32(kBlockHeader)
                                                        : u16(kBlockHeader);
  if (number >= interfaces_.size()) return break_off("a packet is of no interface of its section");
  const Interface& interface = interfaces_[number];
  record.link_type = interface.link_type;
  std::size_t captured = 0;
  std::uint64_t units = 0;
  if (type_ == kSimplePacket) {  // without a time
    record.original_size = u32(kBlockHeader);
    captured = std::min(record.original_size, body_.size() - header);
    if (interface.snap_length > 0)
      captured = std::min<std::size_t>(captured, interface.snap_length);
  } else {
    units = std::uint64_t{u32(kBlockHeader + 4)} << 32U | u32(kBlockHeader + 8);
    captured = u32(kBlockHeader + 12);
    record.original_size = u32(kBlockHeader + 16);
  }
  if (captured > body_.size() - header) return break_off("a packet is longer than its block");
  const auto time = time_ns(interface, units);
  if (!time) return break_off("a packet has an impossible time");
  record.arrival_ns = *time;
  record.bytes = std::span(body_).subspan(header, captured);
  return true;
}

/// Nothing where 64 bits do not hold it as nanoseconds, or it lies before 1970.
std::optional<std::int64_t> PcapngFile::time_ns(const Interface& interface,
                                                std::uint64_t units) const {
  constexpr std::int64_t kMostSeconds = 9'000'000'000;
  constexpr int kMostDigits = 19, kMostBits = 63, kExactBits = 34;  // of units, and as nanoseconds
  std::uint64_t seconds = 0, rest = 0;
  if (interface.is_binary) {
    if (interface.digits > kMostBits) return std::nullopt;
    seconds = units >> interface.digits;
    rest = units - (seconds << interface.digits);
    const int lost = std::max(interface.digits - kExactBits, 0);
    rest = (rest >> lost) * kSecond >> (interface.digits - lost);
  } else {
    if (interface.digits > kMostDigits) return std::nullopt;
    const std::uint64_t second = power_of_ten(interface.digits);
    seconds = units / second;
    rest = interface.digits > 9 ? units % second / power_of_ten(interface.digits - 9)
                                : units % second * power_of_ten(9 - interface.digits);
  }
  if (seconds > static_cast<std::uint64_t>(kMostSeconds)) return std::nullopt;
  if (interface.offset_s > kMostSeconds || interface.offset_s < -kMostSeconds) return std::nullopt;
  const std::int64_t since_epoch = static_cast<std::int64_t>(seconds) + interface.offset_s;
  if (since_epoch < 0 || since_epoch > kMostSeconds) return std::nullopt;
  return since_epoch * kSecond + static_cast<std::int64_t>(rest);
}

}  // namespace scree
