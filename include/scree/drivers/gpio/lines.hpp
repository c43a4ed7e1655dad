#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"

namespace scree::gpio {

/// A line that this process holds, as the library has it.
struct HeldLine;
struct ReleaseLine {
  void operator()(HeldLine* line) const;
};
using LineHandle = std::unique_ptr<HeldLine, ReleaseLine>;

/// A line that is driven, and is opened again when its chip comes back. When it is released, at the
/// end of the process at the latest, its level is up to the chip: choose the active level so that a
/// robot without driver stops.
class Output {
public:
  /// @param name CHIP:LINE; the chip's name, label or path, the line's number or name
  static Result<Output> open(const std::string& name, bool is_active_low, bool is_on);

  /// False when it could not be set: the chip is gone, or another program holds the line.
  bool set(bool is_on);

private:
  std::string name_;
  bool is_active_low_ = false;
  LineHandle line_;  // none while the chip is gone
};

/// A line on which pulses arrive: their rising edges (falling, where it is active low). Opened
/// again when its chip comes back.
class PulseInput {
public:
  /// @param name as that of an Output
  static Result<PulseInput> open(const std::string& name, bool is_active_low);

  /// To poll for reading. -1 while the line is not to be had; each call tries anew.
  int descriptor();
  /// Host time of the next pulse that waits, by the kernel's stamp; or nothing. Never blocks.
  std::optional<std::int64_t> read();
  /// Lets go of a line whose chip is gone.
  void close() { line_.reset(); }

private:
  std::string name_;
  bool is_active_low_ = false;
  LineHandle line_;  // none while the chip is gone
};

/// The name of the program that holds a line, as it has given it; empty: nobody does. Only looks.
/// @param name as that of an Output
Result<std::string> holder_of(const std::string& name);

/// Whether a text can be the name of a line, or is empty for none; nothing is opened.
Result<void> check_name(const std::string& name);

/// Whether this computer has the lines that the configuration names, as far as this user may look.
/// Nothing is changed. One sentence, which names the key, where it has not.
Result<void> check_lines(const GpioSettings& settings);

/// The lines that the configuration names.
struct Lines {
  std::optional<PulseInput> pps;
  std::optional<Output> stop, heartbeat;  ///< stop begins on: nothing has been seen yet

  /// One sentence, which names the key, where a named line is not to be had.
  static Result<Lines> open(const GpioSettings& settings);
};

/// A kernel's stamp of an edge on the host's clock. Linux stamps on the monotonic clock (before 5.7
/// on the real-time clock); which one it is shows by which is nearer to now.
std::int64_t edge_host_ns(std::int64_t stamp_ns, std::int64_t monotonic_now_ns,
                          std::int64_t host_now_ns);

}  // namespace scree::gpio
