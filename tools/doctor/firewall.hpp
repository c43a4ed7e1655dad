#pragma once

#include <string>
#include <string_view>

#include "doctor/finding.hpp"

namespace scree {

/// Whether a ruleset lets datagrams to a port in, as far as its text shows it: a chain of incoming
/// packets that drops what it does not name must name the port, and no rule may drop what goes to
/// the port.
/// @param nft what `nft list ruleset` prints, which has iptables-nft's rules too
/// @param iptables what `iptables -S INPUT` prints of the older tables
Finding check_firewall(std::string_view nft, std::string_view iptables, int port);

}  // namespace scree
