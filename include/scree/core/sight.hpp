#pragma once

#include <cstdint>

namespace scree {

/// What is known of a place.
enum class Sight : std::uint8_t { unseen, empty, occupied };

}  // namespace scree
