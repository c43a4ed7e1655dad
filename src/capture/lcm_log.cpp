#include "scree/capture/lcm_log.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

namespace scree {
namespace {

// An event: the magic number, event number and time of eight bytes, the lengths of channel and data
// of four bytes, then these two. All numbers are big-endian.
constexpr std::uint32_t kMagic = 0xEDA1DA01;
constexpr std::size_t kMagicSize = 4;
constexpr std::size_t kHeaderSize = 28;
constexpr std::size_t kTimeOffset = 12, kChannelLengthOffset = 20, kDataLengthOffset = 24;
constexpr std::uint64_t kLongestChannel = 63;               // LCM_MAX_CHANNEL_NAME_LENGTH
constexpr std::uint64_t kLatestUs = 9'000'000'000'000'000;  // as nanoseconds it fits in 64 bits

using Header = std::array<char, kHeaderSize>;

std::uint64_t big_endian(const Header& bytes, std::size_t offset, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = offset; i < offset + size; ++i) {
    value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
  }
  return value;
}

}  // namespace

bool is_lcm_log(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;
  std::ifstream stream(file, std::ios::binary);
  Header header{};
  return stream.read(header.data(), kMagicSize) && big_endian(header, 0, kMagicSize) == kMagic;
}

Result<LcmLogReader> LcmLogReader::open(const std::filesystem::path& file) {
  if (!is_lcm_log(file)) return fail(fmt::format("{}: is no LCM log", file.string()));
  LcmLogReader reader;
  reader.name_ = file.string();
  reader.stream_.open(file, std::ios::binary);
  std::error_code error;
  reader.size_ = std::filesystem::file_size(file, error);
  if (!reader.stream_ || error) return fail(fmt::format("cannot read {}", file.string()));
  return reader;
}

bool LcmLogReader::next(LcmEvent& event) {
  while (stream_) {
    const std::streamoff begin = stream_.tellg();
    const auto left = size_ - static_cast<std::uint64_t>(begin);
    if (left == 0) return false;
    Header header{};
    stream_.read(header.data(), kHeaderSize);
    const std::uint64_t magic = big_endian(header, 0, kMagicSize);
    const std::uint64_t time_us = big_endian(header, kTimeOffset, 8);
    const std::uint64_t channel = big_endian(header, kChannelLengthOffset, 4);
    const std::uint64_t data = big_endian(header, kDataLengthOffset, 4);
    const bool is_whole = stream_ && magic == kMagic && time_us <= kLatestUs &&
                          channel <= kLongestChannel && kHeaderSize + channel + data <= left;
    if (is_whole) {
      event.arrival_ns = static_cast<std::int64_t>(time_us) * 1000;
      event.channel.resize(channel);
      message_.resize(data);
      stream_.read(event.channel.data(), static_cast<std::streamsize>(channel));
      stream_.read(reinterpret_cast<char*>(message_.data()), static_cast<std::streamsize>(data));
      event.message = message_;
      position_ = static_cast<std::uint64_t>(begin) + kHeaderSize + channel + data;
      return static_cast<bool>(stream_);
    }
    skip_to_magic(begin + 1);
  }
  return false;
}

void LcmLogReader::skip_to_magic(std::streamoff from) {
  stream_.clear();
  stream_.seekg(from);
  ++skipped_;
  std::uint32_t last = 0;
  for (char byte = 0; stream_.get(byte);) {
    last = last << 8 | static_cast<std::uint8_t>(byte);
    ++skipped_;
    if (last != kMagic) continue;
    skipped_ -= kMagicSize;
    stream_.seekg(-static_cast<std::streamoff>(kMagicSize), std::ios::cur);
    return;
  }
}

std::string LcmLogReader::broken_off() const {
  if (skipped_ == 0) return "";
  return fmt::format("{}: {} bytes belong to no whole message", name_, skipped_);
}

}  // namespace scree
