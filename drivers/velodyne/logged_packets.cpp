#include "scree/drivers/velodyne/logged_packets.hpp"

#include <utility>

namespace scree::velodyne {
namespace {

/// @pre bytes.size() >= kDataPacketSize
bool begins_with_blocks(Bytes bytes) {
  for (std::size_t block = 0; block < kBlocks; ++block) {
    if (read<std::uint16_t>(bytes, block * kBlockSize) != kBlockFlag) return false;
  }
  return true;
}

bool ends_with_length_and(std::size_t size, Bytes message) {
  if (message.size() == size) return true;
  constexpr std::size_t kLengthSize = 4;
  if (message.size() < size + kLengthSize) return false;
  std::size_t length = 0;
  for (const std::uint8_t byte : message.last(size + kLengthSize).first(kLengthSize)) {
    length = length << 8U | byte;
  }
  return length == size;
}

}  // namespace

Bytes take_logged_packet(Bytes& message) {
  for (std::size_t at = 0; at + kDataPacketSize <= message.size(); ++at) {
    if (!begins_with_blocks(message.subspan(at))) continue;
    const Bytes packet = message.subspan(at, kDataPacketSize);
    message = message.subspan(at + kDataPacketSize);
    return packet;
  }
  const Bytes all = std::exchange(message, {});
  for (const std::size_t size : {kDataPacketSize, kPositionPacketSize}) {
    if (ends_with_length_and(size, all)) return all.last(size);
  }
  return {};
}

}  // namespace scree::velodyne
