#pragma once

#include <scree/health_t.hpp>
#include <string>

namespace scree::cli {

/// Health as one line of JSON without its line feed: the members of the message, words for its
/// numbers of states, null for what is no number. `health` is ok or blind.
std::string health_json(const health_t& health);

}  // namespace scree::cli
