#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "scree/core/result.hpp"

namespace scree {

/// A message of a log. It lies in the reader's memory until its next read.
struct LcmEvent {
  std::int64_t arrival_ns = 0;  ///< at the logger, host time; the file has microseconds
  std::string channel;
  std::span<const std::uint8_t> message;  ///< as it was published: fingerprint, then the values
};

/// Whether a file is a log as lcm-logger writes it, by its first bytes.
bool is_lcm_log(const std::filesystem::path& file);

/// Reads a log as lcm-logger writes it (LCM's lcm_eventlog_t). Any bytes are safe, unlike with
/// LCM's own reader: what is garbled is passed over up to the next message.
class LcmLogReader {
public:
  static Result<LcmLogReader> open(const std::filesystem::path& file);

  /// False at the end.
  bool next(LcmEvent& event);

  /// How many bytes of the file were read.
  std::uint64_t position() const { return position_; }
  /// What of the file belongs to no whole message, one sentence; empty when all of it does.
  std::string broken_off() const;

private:
  void skip_to_magic(std::streamoff from);

  std::string name_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, position_ = 0, skipped_ = 0;
  std::vector<std::uint8_t> message_;
};

}  // namespace scree
