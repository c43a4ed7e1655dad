#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace scree {

/// Appends a message as lcm-logger writes it into a log.
/// @param time_us when it was sent, microseconds since the UNIX epoch
void append_lcm_event(std::int64_t number, std::int64_t time_us, std::string_view channel,
                      std::span<const std::uint8_t> message, std::vector<std::uint8_t>& log);

}  // namespace scree
