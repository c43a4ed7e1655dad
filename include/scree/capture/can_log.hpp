#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "scree/core/can_frame.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// Why a line of a log was not used.
enum class CanLineRefusal : std::uint8_t {
  none,
  form,        ///< not `(seconds.fraction) interface frame`
  time,        ///< no time stamp of a host's clock
  identifier,  ///< neither 3 nor 8 digits, or beyond its 11 or 29 bits
  data         ///< no whole bytes, more than a frame holds, or CAN XL
};
inline constexpr std::size_t kCanLineRefusals = 5;

/// For people.
inline constexpr std::array<std::string_view, kCanLineRefusals> kCanLineReasons = {
    "accepted", "not of the form (time) interface frame, as candump -L, -ta and -tA write it",
    "time stamp is none of a clock, as candump -L, -ta and -tA write it",
    "identifier is neither 3 nor 8 hexadecimal digits in its range",
    "data are not whole bytes, or more than a frame holds"};

/// Reads one line as `candump -L` or `candump -ta` writes it, without its end; any bytes are safe.
/// `interface` is a part of the line.
///
/// What it takes of the first (can-utils, lib.h): `123#DEADBEEF` with up to 8 bytes, dots between
/// them allowed, and a raw length code `_9` behind eight bytes; `123#R` and `123#R4`; CAN FD
/// `123##1DEADBEEF` with a digit of flags; 8 digits for an extended identifier, and for an error
/// frame, which has bit 29 set; one to nine digits of a second's fraction; ` R` or ` T`, the
/// direction, at the end. Of the second: `can0  123   [4]  DE AD BE EF`, with `RX - -` or `TX - -`
/// behind the interface
/// (-x), and what it writes behind the bytes.
CanLineRefusal parse_can_line(std::string_view line, CanFrame& frame, std::string_view& interface);

struct CanLogCounters {
  std::uint64_t frames = 0;                               ///< handed out
  std::array<std::uint64_t, kCanLineRefusals> refused{};  ///< lines by CanLineRefusal; [none] is 0

  std::uint64_t not_later = 0;  ///< frames whose time is not after that of the frame before
  std::int64_t latest_ns = 0;   ///< the latest time of a frame

  std::uint64_t all_refused() const;
  /// Whether the times are no times but differences, as `candump -td` writes them.
  bool has_differences() const;
};

/// Reads a capture's can.log. Empty lines and those that begin with # are passed over.
class CanLogReader {
public:
  static Result<CanLogReader> open(const std::filesystem::path& file);

  /// False at the end of the file. What a refused line holds is left out and counted.
  bool next(CanFrame& frame, std::string* interface = nullptr);

  const CanLogCounters& counters() const { return counters_; }
  /// How many bytes of the file were read, about.
  std::uint64_t position() const { return position_; }

private:
  std::ifstream stream_;
  std::array<char, 512> line_{};  ///< twice the longest line that a frame needs
  std::uint64_t position_ = 0;
  bool is_first_ = true;
  std::int64_t last_ns_ = 0;
  CanLogCounters counters_;
};

/// Writes a log as `candump -L` does, with microseconds.
class CanLogWriter {
public:
  static Result<CanLogWriter> create(const std::filesystem::path& file);

  void write(const CanFrame& frame, std::string_view interface);
  /// Writes out what is buffered: the file is whole from here on, whatever happens. An error (a
  /// full disk, a file that was removed) shows itself here or in close().
  Result<void> flush();
  Result<void> close();

private:
  Result<void> result() const;

  std::string name_;
  std::ofstream stream_;
};

}  // namespace scree
