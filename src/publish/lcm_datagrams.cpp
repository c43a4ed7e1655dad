#include "lcm_datagrams.hpp"

#include <algorithm>

namespace scree {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kWhole = 0x4C433032, kFragment = 0x4C433033;  // "LC02", "LC03"
constexpr std::size_t kWholeHeader = 8, kFragmentHeader = 20;
constexpr std::size_t kLongestChannel = 63;

/// In network byte order. @pre there are so many bytes
std::uint32_t number(Bytes bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(offset, size)) value = value << 8U | byte;
  return value;
}

/// The channel at the beginning, which ends with a zero; nothing where it does not.
std::optional<std::string_view> channel_of(Bytes bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  const auto length = static_cast<std::size_t>(end - bytes.begin());
  if (end == bytes.end() || length > kLongestChannel) return std::nullopt;
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), length);
}

}  // namespace

std::optional<LcmMessage> LcmDatagrams::refuse() {
  ++refused_;
  return std::nullopt;
}

std::optional<LcmMessage> LcmDatagrams::take(Bytes datagram, std::uint64_t sender) {
  if (datagram.size() < kWholeHeader) return refuse();
  switch (number(datagram, 0, 4)) {
    case kWhole:
      return take_whole(datagram);
    case kFragment:
      return datagram.size() < kFragmentHeader ? refuse() : take_fragment(datagram, sender);
    default:
      return refuse();
  }
}

std::optional<LcmMessage> LcmDatagrams::take_whole(Bytes datagram) {
  const Bytes rest = datagram.subspan(kWholeHeader);
  const auto channel = channel_of(rest);
  if (!channel) return refuse();
  return LcmMessage{*channel, rest.subspan(channel->size() + 1)};
}

/// The one under way, else nothing.
LcmDatagrams::Partial* LcmDatagrams::partial_of(std::uint64_t sender, std::uint32_t sequence) {
  const auto found = std::ranges::find_if(partials_, [&](const Partial& partial) {
    return partial.size > 0 && partial.sender == sender && partial.sequence == sequence;
  });
  return found == partials_.end() ? nullptr : &*found;
}

std::optional<LcmMessage> LcmDatagrams::take_fragment(Bytes datagram, std::uint64_t sender) {
  const std::uint32_t sequence = number(datagram, 4, 4), size = number(datagram, 8, 4),
                      offset = number(datagram, 12, 4), index = number(datagram, 16, 2);
  Bytes data = datagram.subspan(kFragmentHeader);
  Partial* partial = partial_of(sender, sequence);
  if (index == 0) {
    const auto channel = channel_of(data);
    if (!channel || size == 0 || size > kLongestMessage) return refuse();
    if (partial == nullptr) {
      partial = &*std::ranges::min_element(
          partials_, {}, [](const Partial& other) { return other.size == 0 ? 0 : other.begun; });
    }
    partial->sender = sender;
    partial->sequence = sequence;
    partial->size = size;
    partial->begun = ++begun_;
    partial->channel.assign(channel->begin(), channel->end());
    partial->data.clear();
    data = data.subspan(channel->size() + 1);
  }
  // They are sent in order; where one was lost or overtaken, the message is lost.
  const bool follows = partial != nullptr && size == partial->size &&
                       offset == partial->data.size() && data.size() <= size - offset;
  if (!follows) {
    if (partial != nullptr) partial->size = 0;
    return refuse();
  }
  partial->data.insert(partial->data.end(), data.begin(), data.end());
  if (partial->data.size() < size) return std::nullopt;
  partial->size = 0;
  return LcmMessage{{partial->channel.data(), partial->channel.size()}, partial->data};
}

}  // namespace scree
