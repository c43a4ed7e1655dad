#include "doctor/firewall.hpp"

#include <spdlog/fmt/fmt.h>

#include <cctype>

#include "doctor/proc_text.hpp"

namespace scree {
namespace {

bool has(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

/// Whether the number stands there by itself.
bool names(std::string_view text, const std::string& number) {
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0;
  };
  for (std::size_t at = 0; (at = text.find(number, at)) != std::string_view::npos; ++at) {
    if (!(at > 0 && is_digit(at - 1)) && !is_digit(at + number.size())) return true;
  }
  return false;
}

struct Chain {
  bool drops_by_default = false, names_port = false, drops_port = false;

  void take_rule(std::string_view line, const std::string& port) {
    if (!has(line, "dport") || !names(line, port)) return;
    names_port = true;
    for (const char* verdict : {" drop", " reject", " DROP", " REJECT"}) {
      drops_port = drops_port || has(line, verdict);
    }
  }
  bool lets_in() const { return !drops_port && (names_port || !drops_by_default); }
};

bool nft_lets_in(std::string_view ruleset, const std::string& port) {
  bool lets_in = true, is_input = false;
  Chain chain;
  const auto end_chain = [&] {
    lets_in = lets_in && (!is_input || chain.lets_in());
    chain = {};
    is_input = false;
  };
  while (!ruleset.empty()) {
    const std::string_view line = take_line(ruleset);
    if (has(line, "chain ")) end_chain();
    if (has(line, "hook input")) {
      is_input = true;
      chain.drops_by_default = has(line, "policy drop");
    }
    chain.take_rule(line, port);
  }
  end_chain();
  return lets_in;
}

bool iptables_lets_in(std::string_view rules, const std::string& port) {
  Chain chain;
  while (!rules.empty()) {
    const std::string_view line = take_line(rules);
    if (has(line, "-P INPUT DROP")) chain.drops_by_default = true;
    chain.take_rule(line, port);
  }
  return chain.lets_in();
}

}  // namespace

Finding check_firewall(std::string_view nft, std::string_view iptables, int port) {
  const std::string subject = "firewall";
  const std::string number = std::to_string(port);
  if (!nft_lets_in(nft, number)) {
    return wrong(subject,
                 fmt::format("it seems to drop what comes to UDP port {}: look at `nft list "
                             "ruleset`, and accept `udp dport {}`",
                             port, port));
  }
  if (!iptables_lets_in(iptables, number)) {
    return wrong(subject,
                 fmt::format("it seems to drop what comes to UDP port {0}: iptables -I INPUT "
                             "-p udp --dport {0} -j ACCEPT",
                             port));
  }
  return ok(subject, fmt::format("no rule keeps UDP port {} from packets", port));
}

}  // namespace scree
