#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "scree/drivers/xsens/refusal.hpp"
#include "scree/drivers/xsens/wire.hpp"

namespace scree::xsens {

/// A whole message with the right checksum.
struct Message {
  MessageId id{};
  Bytes data;                    ///< lies in the framer until its next take()
  std::size_t size = 0;          ///< on the wire, header and checksum included
  std::size_t bytes_behind = 0;  ///< of the same take(), after the message
};

/// Writes a message with its checksum into `out` and gives its size.
/// @pre data has at most 254 bytes and `out` room for 5 more
std::size_t write_message(MessageId id, Bytes data, std::span<std::uint8_t> out);

struct FramingCounters {
  std::uint64_t messages = 0;       ///< found
  std::uint64_t checksum = 0;       ///< see Refusal
  std::uint64_t length = 0;         ///< see Refusal
  std::uint64_t bytes_skipped = 0;  ///< that belong to no message
};

/// Finds Xbus messages in bytes that split and join them anywhere (MT0101P, "Message structure").
/// Any bytes are safe; memory is fixed. A preamble that turns out to be none is passed over, and
/// the search goes on at the byte behind it, so that it hides no message.
class Framer {
public:
  /// Calls on_message(const Message&) for each message that the bytes complete, in order.
  template <class OnMessage>
  void take(Bytes bytes, OnMessage&& on_message) {
    while (!bytes.empty()) {
      bytes = hold(bytes);
      search(bytes.size(), false, on_message);
    }
  }
  /// At the end of the bytes: searches what waited for the rest of a message.
  template <class OnMessage>
  void flush(OnMessage&& on_message) {
    search(0, true, on_message);
  }

  const FramingCounters& counters() const { return counters_; }

private:
  /// Takes in as many as fit and gives the rest; at least one fits, whatever waits.
  Bytes hold(Bytes bytes);
  /// The next message, or nothing (size 0): more bytes are needed.
  Message next(bool at_end);
  void skip(std::size_t bytes);

  template <class OnMessage>
  void search(std::size_t not_held, bool at_end, OnMessage&& on_message) {
    for (Message message = next(at_end); message.size > 0; message = next(at_end)) {
      message.bytes_behind = end_ - begin_ + not_held;
      on_message(static_cast<const Message&>(message));
    }
  }

  std::array<std::uint8_t, 2 * kLongestMessage> held_{};
  std::size_t begin_ = 0, end_ = 0;
  FramingCounters counters_;
};

}  // namespace scree::xsens
