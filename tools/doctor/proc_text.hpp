#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The kernel's texts under /proc (man 5 proc). Any text is safe.
namespace scree {

/// Takes off the first line of any text.
std::string_view take_line(std::string_view& text);

/// A line of /proc/net/udp.
struct UdpSocket {
  std::uint32_t address = 0;  ///< IPv4, most significant byte first in value; 0: all
  std::uint16_t port = 0;
  std::uint64_t inode = 0;  ///< a descriptor of its process is a link to socket:[inode]
};
std::vector<UdpSocket> parse_udp_sockets(std::string_view proc_net_udp);

/// The greatest value that stands for "unlimited".
inline constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};
/// The soft limit with that name ("Max realtime priority") in /proc/PID/limits.
std::optional<std::uint64_t> parse_limit(std::string_view proc_limits, std::string_view name);

/// What stands behind the name ("VmLck") and the colon in /proc/PID/status.
std::string_view status_value(std::string_view proc_status, std::string_view name);
/// Bit number `capability` (CAP_SYS_NICE ...) of the effective capabilities.
bool has_capability(std::string_view proc_status, int capability);

/// Whether a thread has a real-time policy, by its /proc/PID/task/TID/stat.
bool is_real_time(std::string_view proc_stat);

}  // namespace scree
