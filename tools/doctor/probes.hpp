#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doctor/can_link.hpp"
#include "doctor/check_system.hpp"
#include "doctor/lidar_traffic.hpp"
#include "scree/core/descriptor.hpp"

// What the doctor asks the kernel. Nothing here draws conclusions.
namespace scree::cli {

/// A whole file, empty where it cannot be read.
std::string read_text(const std::filesystem::path& file);
/// What a shell command prints; empty where it fails.
std::string output_of(const char* command);

struct Process {
  int id = 0;
  std::string name;
};
/// Who has bound a UDP port, and on which local address.
struct PortOwner {
  Process process;            ///< its id is 0 where it cannot be known without being root
  std::uint32_t address = 0;  ///< IPv4, most significant byte first in value
};
/// Nothing: nobody has.
std::optional<PortOwner> owner_of_port(int port);
/// Whoever else has a device open, as far as may be known.
std::optional<Process> user_of_device(const std::string& device);

Running how_runs(const std::optional<Process>& screed);
SerialFacts look_at_serial(const std::string& device);
std::optional<CanLink> look_at_can(const std::string& interface);
std::vector<std::uint32_t> own_addresses();

/// Sees the lidar's data packets on the wire, before any firewall.
class WireListener {
public:
  WireListener();
  /// Whether this user has the right to (CAP_NET_RAW).
  bool is_open() const { return socket_.is_open(); }
  /// Counts what waits.
  void listen(DatagramCounts& seen) const;

private:
  Descriptor socket_;
};

}  // namespace scree::cli
