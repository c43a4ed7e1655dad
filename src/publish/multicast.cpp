#include "scree/publish/multicast.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>

namespace scree {
namespace {

constexpr std::string_view kProvider = "udpm://";

std::string no_url(const std::string& url) {
  return "the LCM url " + url +
         " must look like udpm://239.255.76.67:7667?ttl=0, with a multicast address "
         "(224.0.0.0 to 239.255.255.255) and a port";
}

template <class Number>
bool is_number(std::string_view text, Number least) {
  Number value{};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  return error == std::errc{} && end == last && value >= least;
}

/// What is wrong with the options of a url; empty: nothing. LCM takes what is no number for 0, and
/// passes over what it does not know.
std::string wrong_option(std::string_view url) {
  std::size_t at = url.find('?');
  while (at != std::string_view::npos) {
    const std::string_view option = url.substr(at + 1, url.find('&', at + 1) - at - 1);
    at = url.find('&', at + 1);
    const std::string_view key = option.substr(0, option.find('='));
    const std::string_view value = option.substr(std::min(key.size() + 1, option.size()));
    if (key == "ttl") {
      if (!is_number<std::uint8_t>(value, 0)) return "the ttl of the LCM url must be 0 to 255";
    } else if (key == "recv_buf_size") {
      if (!is_number<std::int32_t>(value, 1)) return "recv_buf_size of the LCM url must be bytes";
    } else if (!option.empty()) {
      return "the LCM url has an option \"" + std::string(key) +
             "\", and takes ttl and recv_buf_size";
    }
  }
  return "";
}

/// Whether tcpq://HOST:PORT has a port that there can be; without one it has LCM's.
bool has_possible_port(std::string_view url) {
  const std::string_view server = url.substr(url.find("//") + 2);
  const std::size_t colon = server.find(':');
  return colon == std::string_view::npos ||
         is_number<std::uint16_t>(server.substr(colon + 1, server.find('?') - colon - 1), 1);
}

Result<sockaddr_in> group_of(const std::string& url) {
  const std::string_view rest = std::string_view(url).substr(kProvider.size());
  const std::string network(rest.substr(0, rest.find('?')));
  const std::size_t colon = network.find(':');
  sockaddr_in group{};
  group.sin_family = AF_INET;
  const std::string address = network.substr(0, colon);
  std::uint16_t port = 0;
  if (colon != std::string::npos) {
    const char* end = network.data() + network.size();
    const auto read = std::from_chars(network.data() + colon + 1, end, port);
    if (read.ec != std::errc{} || read.ptr != end) port = 0;
  }
  if (port == 0 || inet_pton(AF_INET, address.c_str(), &group.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(group.sin_addr.s_addr))) {
    return fail(no_url(url));
  }
  group.sin_port = htons(port);
  return group;
}

}  // namespace

Result<void> check_lcm_url(const std::string& url) {
  if (is_multicast(url)) {
    if (const std::string wrong = wrong_option(url); !wrong.empty()) {
      return fail(wrong + " (" + url + ")");
    }
    return group_of(url).map([](const sockaddr_in&) {});
  }
  if (url.starts_with("tcpq://") && !has_possible_port(url)) {
    return fail("the port of the LCM url " + url + " must be 1 to 65535");
  }
  for (const std::string_view other : {"tcpq://", "mpudpm://", "memq://", "file://"}) {
    if (url.starts_with(other)) return {};
  }
  return fail(no_url(url));
}

Result<void> check_multicast(const std::string& lcm_url) {
  if (!is_multicast(lcm_url)) return check_lcm_url(lcm_url);
  const auto group = group_of(lcm_url);
  if (!group) return tl::make_unexpected(group.error());

  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return fail(std::string("cannot open a UDP socket: ") + std::strerror(errno));
  ip_mreq membership{};
  membership.imr_multiaddr = group->sin_addr;
  // Neither call sends anything: the kernel only looks for a route.
  const bool routed =
      connect(probe, reinterpret_cast<const sockaddr*>(&*group), sizeof *group) == 0 &&
      setsockopt(probe, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
  const int reason = errno;
  close(probe);
  if (routed) return {};
  return fail("no route to the multicast group of " + lcm_url + " (" + std::strerror(reason) +
              "); to use LCM on this computer alone, run as root: ip link set lo multicast on; "
              "ip route add 224.0.0.0/4 dev lo");
}

bool is_multicast(const std::string& lcm_url) {
  return lcm_url.starts_with(kProvider);
}

Result<Descriptor> listen_to_group(const std::string& lcm_url) {
  const auto group = group_of(lcm_url);
  if (!group) return tl::make_unexpected(group.error());
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ip_mreq membership{};
  membership.imr_multiaddr = group->sin_addr;
  const int shared = 1, buffer = 4 << 20;  // a long list comes in many datagrams at once
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  if (!socket.is_open() ||
      setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &shared, sizeof shared) != 0 ||
      bind(socket.get(), reinterpret_cast<const sockaddr*>(&*group), sizeof *group) != 0 ||
      setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) !=
          0) {
    return fail("cannot listen to " + lcm_url + ": " + std::strerror(errno));
  }
  return socket;
}

}  // namespace scree
