#pragma once

#include <scree/obstacle_list_t.hpp>

#include "scree/core/obstacle.hpp"

namespace scree {

/// The LCM message of a list. Allocates only when the message's vector has to grow.
void to_message(const ObstacleList& list, obstacle_list_t& message);

/// The list of an LCM message. Allocates only when the list has to grow.
void from_message(const obstacle_list_t& message, ObstacleList& list);

}  // namespace scree
