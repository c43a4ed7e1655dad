#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "unit/xsens/message_builder.hpp"

namespace scree::test {

/// The device's side of the start (MT0101P, "States"): bytes from the host in, its answers out. It
/// understands only what comes at its own bit rate.
class EmulatedMti {
public:
  int baud = 921600;
  bool is_measuring = true;
  bool is_silent = false;
  std::map<int, int> refuses;    ///< message id, error code
  std::map<int, int> ignores;    ///< message id, how many of them
  std::map<int, int> loses;      ///< message id, how many of its acknowledgements
  int highest_rate = 400;        ///< Hz
  std::vector<int> heard;        ///< message ids, in order
  ByteVector outputs;            ///< as set
  std::vector<int> bauds_heard;  ///< that the host's bytes came at
  unsigned samples = 0;

  ByteVector answer(const ByteVector& bytes, int line_baud) {
    if (bauds_heard.empty() || bauds_heard.back() != line_baud) bauds_heard.push_back(line_baud);
    if (line_baud != baud || is_silent) return {};
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
    ByteVector answers;
    while (const auto request = next()) {
      const ByteVector one = respond(request->first, request->second);
      if (loses[request->first]-- > 0) continue;
      answers.insert(answers.end(), one.begin(), one.end());
    }
    return answers;
  }

  /// The next MTData2 message; nothing in config state.
  ByteVector sample() {
    if (!is_measuring || is_silent) return {};
    const unsigned i = samples++;
    return data_message({integer(0x1020, i & 0xFFFFU, 2), integer(0x1060, 100ULL * i, 4),
                         reals(0x2010, {1, 0, 0, 0}), reals(0x4020, {0, 0, 9.75}),
                         reals(0x8020, {0, 0, 0.5}), integer(0xE020, 3, 4)});
  }
  bool heard_any(int id) const { return std::count(heard.begin(), heard.end(), id) > 0; }

private:
  std::optional<std::pair<int, ByteVector>> next() {
    while (!waiting_.empty() && waiting_[0] != 0xFA) waiting_.erase(waiting_.begin());
    if (waiting_.size() < 5 || waiting_.size() < waiting_[3] + 5U) return std::nullopt;
    const auto end = waiting_.begin() + waiting_[3] + 5;
    std::uint8_t sum = 0;
    for (auto byte = waiting_.begin() + 1; byte != end; ++byte) {
      sum = static_cast<std::uint8_t>(sum + *byte);
    }
    std::pair<int, ByteVector> request{waiting_[2], {waiting_.begin() + 4, end - 1}};
    waiting_.erase(waiting_.begin(), end);
    if (sum != 0) return next();
    return request;
  }

  ByteVector respond(int id, const ByteVector& data) {
    heard.push_back(id);
    if (ignores[id]-- > 0) return {};
    if (const auto refusal = refuses.find(id); refusal != refuses.end()) {
      return message(0x42, {static_cast<std::uint8_t>(refusal->second)});
    }
    const auto ack = static_cast<unsigned>(id) + 1;
    switch (id) {
      case 0x30:
        is_measuring = false;
        return message(ack, {});
      case 0x3F:
        is_measuring = false;
        return {};
      default:
        break;
    }
    if (is_measuring) return {};  // only GoToConfig is heard while it measures
    switch (id) {
      case 0x00:
        return message(ack, {0x07, 0x71, 0x23, 0x45});
      case 0x10:
        is_measuring = true;
        return message(ack, {});
      case 0x18:
        next_baud_ = baud_of(data.at(0));
        return message(ack, {});
      case 0x40:
        baud = next_baud_.value_or(baud);
        is_measuring = true;
        return message(ack, {});
      case 0xC0:
        outputs = data;
        for (std::size_t i = 0; i + 4 <= outputs.size(); i += 4) {
          const int rate = outputs[i + 2] * 256 + outputs[i + 3];
          if (rate == 0xFFFF || rate <= highest_rate) continue;
          outputs[i + 2] = static_cast<std::uint8_t>(highest_rate / 256);
          outputs[i + 3] = static_cast<std::uint8_t>(highest_rate % 256);
        }
        return message(ack, outputs);
      default:
        return message(0x42, {4});
    }
  }

  static int baud_of(int code) {
    static const std::map<int, int> codes = {
        {0x02, 115200}, {0x0A, 921600}, {0x00, 460800}, {0x0C, 2000000}, {0x09, 9600}};
    return codes.at(code);
  }

  ByteVector waiting_;
  std::optional<int> next_baud_;
};

}  // namespace scree::test
