#include "scree/drivers/xsens/framing.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace scree::xsens {
namespace {

enum class FrameStatus : std::uint8_t { whole, incomplete, no_message, checksum, length };

/// The message that begins with the first byte, if it does. @pre one byte at least
std::pair<FrameStatus, Message> parse_frame(Bytes bytes) {
  if (bytes[0] != kPreamble) return {FrameStatus::no_message, {}};
  if (bytes.size() > 1 && bytes[1] != kMasterDevice) return {FrameStatus::no_message, {}};
  if (bytes.size() < kShortHeader) return {FrameStatus::incomplete, {}};
  const bool extended = bytes[3] == kExtendedLength;
  const std::size_t header = extended ? kExtendedHeader : kShortHeader;
  if (bytes.size() < header) return {FrameStatus::incomplete, {}};
  const std::size_t length = extended ? read<std::uint16_t>(bytes, kShortHeader) : bytes[3];
  if (length > kLongestData) return {FrameStatus::length, {}};
  const std::size_t size = header + length + 1;
  if (bytes.size() < size) return {FrameStatus::incomplete, {}};
  if (std::accumulate(bytes.begin() + 1, bytes.begin() + static_cast<std::ptrdiff_t>(size), 0U) %
          0x100U !=
      0) {
    return {FrameStatus::checksum, {}};
  }
  return {FrameStatus::whole,
          {static_cast<MessageId>(bytes[2]), bytes.subspan(header, length), size, 0}};
}

}  // namespace

std::size_t write_message(MessageId id, Bytes data, std::span<std::uint8_t> out) {
  out[0] = kPreamble;
  out[1] = kMasterDevice;
  out[2] = static_cast<std::uint8_t>(id);
  out[3] = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), out.begin() + kShortHeader);
  const std::size_t end = kShortHeader + data.size();
  const auto sum =
      std::accumulate(out.begin() + 1, out.begin() + static_cast<std::ptrdiff_t>(end), 0U);
  out[end] = static_cast<std::uint8_t>(0x100U - sum % 0x100U);
  return end + 1;
}

Bytes Framer::hold(Bytes bytes) {
  std::copy(held_.begin() + static_cast<std::ptrdiff_t>(begin_),
            held_.begin() + static_cast<std::ptrdiff_t>(end_), held_.begin());
  end_ -= begin_;
  begin_ = 0;
  const std::size_t fitting = std::min(bytes.size(), held_.size() - end_);
  std::copy_n(bytes.begin(), fitting, held_.begin() + static_cast<std::ptrdiff_t>(end_));
  end_ += fitting;
  return bytes.subspan(fitting);
}

void Framer::skip(std::size_t bytes) {
  begin_ += bytes;
  counters_.bytes_skipped += bytes;
}

Message Framer::next(bool at_end) {
  while (begin_ < end_) {
    const Bytes waiting = Bytes(held_).subspan(begin_, end_ - begin_);
    const auto [status, message] = parse_frame(waiting);
    if (status == FrameStatus::whole) {
      begin_ += message.size;
      ++counters_.messages;
      return message;
    }
    if (status == FrameStatus::incomplete && !at_end) break;
    if (status == FrameStatus::checksum) ++counters_.checksum;
    if (status == FrameStatus::length) ++counters_.length;
    const auto next_preamble = std::find(waiting.begin() + 1, waiting.end(), kPreamble);
    skip(static_cast<std::size_t>(next_preamble - waiting.begin()));
  }
  return {};
}

}  // namespace scree::xsens
