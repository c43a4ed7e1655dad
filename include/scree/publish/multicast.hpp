#pragma once

#include <string>

#include "scree/core/result.hpp"

namespace scree {

/// Whether a url is one of LCM's, as far as its text tells; of udpm:// also group and port.
Result<void> check_lcm_url(const std::string& url);

/// Whether this computer can send to and receive from the multicast group of an LCM url
/// ("udpm://GROUP:PORT?ttl=N"); urls of other providers always pass. The error says what to do:
/// LCM's own complaint names addresses that do not exist.
Result<void> check_multicast(const std::string& lcm_url);

}  // namespace scree
