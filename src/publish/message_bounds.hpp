#pragma once

#include <cstdint>
#include <span>

namespace scree {

// Whether a message is what its type says, walked through without taking memory: LCM's own decoders
// believe each length that they read, before they look whether so much is there.

bool is_obstacle_list(std::span<const std::uint8_t> message);
bool is_grid(std::span<const std::uint8_t> message);
bool is_health(std::span<const std::uint8_t> message);

}  // namespace scree
