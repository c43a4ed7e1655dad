#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scree/drivers/gpio/lines.hpp"

// The one place that knows libgpiod, of which versions 1 and 2 have different interfaces.
namespace scree::gpio {

struct LineRequest {
  std::string chip, line;
  bool is_active_low;
  bool is_output;
  bool is_on;  ///< of an output: at the beginning
};

/// What is wrong, without the name of the key, where the line is not to be had.
Result<LineHandle> request(const LineRequest& wanted);
/// See gpio::holder_of().
Result<std::string> holder_of(const std::string& chip, const std::string& line);
/// Whether there is such a line; it is not said where this user may not look.
Result<void> check_line(const std::string& chip, const std::string& line);
bool set(HeldLine& line, bool is_on);
int descriptor_of(const HeldLine& line);
/// The kernel's stamp of the next edge that waits.
std::optional<std::int64_t> read_edge(HeldLine& line);

}  // namespace scree::gpio
