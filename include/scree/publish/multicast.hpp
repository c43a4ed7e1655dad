#pragma once

#include <string>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// Whether a url is one of LCM's, as far as its text tells; of udpm:// also group and port.
Result<void> check_lcm_url(const std::string& url);

/// Whether a url is one of LCM's multicast provider, udpm://.
bool is_multicast(const std::string& lcm_url);

/// A socket that hears what is sent to the group of such a url; reading it does not block.
Result<Descriptor> listen_to_group(const std::string& lcm_url);

/// Whether this computer can send to and receive from the multicast group of an LCM url
/// ("udpm://GROUP:PORT?ttl=N"); urls of other providers always pass. The error says what to do:
/// LCM's own complaint names addresses that do not exist.
Result<void> check_multicast(const std::string& lcm_url);

}  // namespace scree
