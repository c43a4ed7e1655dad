#pragma once

#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// Takes the next data or position packet out of a message that some driver has logged, and leaves
/// what follows it; nothing (and an empty rest) where there is none. Whatever type the message has,
/// a packet is known by its blocks' flags, or by being the whole message, or its end behind a
/// length of four bytes, most significant first, as LCM writes arrays. Any bytes are safe.
Bytes take_logged_packet(Bytes& message);

}  // namespace scree::velodyne
