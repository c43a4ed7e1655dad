#include "doctor/probes.hpp"

#include <arpa/inet.h>
#include <grp.h>
#include <ifaddrs.h>
#include <linux/if_packet.h>
#include <linux/rtnetlink.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <pcap/dlt.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

#include "doctor/proc_text.hpp"
#include "scree/capture/datagram.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

/// The first of all other processes whose folder it holds for.
template <class Holds>
std::optional<Process> process_that(Holds holds) {
  std::error_code error;
  for (const auto& folder : fs::directory_iterator("/proc", error)) {
    const std::string name = folder.path().filename();
    int id = 0;
    std::from_chars(name.data(), name.data() + name.size(), id);
    if (id == 0 || id == getpid() || !holds(folder.path())) continue;
    std::string program = read_text(folder.path() / "comm");
    if (!program.empty()) program.pop_back();
    return Process{id, program};
  }
  return std::nullopt;
}

std::optional<Process> process_named(const std::string& name) {
  return process_that(
      [&](const fs::path& folder) { return read_text(folder / "comm") == name + "\n"; });
}

/// Whether one of a process's descriptors is a link to that.
bool has_open(const fs::path& process, const std::string& target) {
  std::error_code error;
  for (const auto& descriptor : fs::directory_iterator(process / "fd", error)) {
    if (fs::read_symlink(descriptor.path(), error) == target) return true;
  }
  return false;
}

}  // namespace

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string output_of(const char* command) {
  const auto close = [](std::FILE* pipe) { pclose(pipe); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(popen(command, "re"), close);
  std::string text;
  std::array<char, 4096> buffer;
  for (std::size_t size = 1; pipe && size > 0;) {
    size = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
    text.append(buffer.data(), size);
  }
  return text;
}

std::optional<PortOwner> owner_of_port(int port) {
  for (const UdpSocket& socket : parse_udp_sockets(read_text("/proc/net/udp"))) {
    if (socket.port != port) continue;
    const std::string target = "socket:[" + std::to_string(socket.inode) + "]";
    auto process = process_that([&](const fs::path& folder) { return has_open(folder, target); });
    // A service's descriptors are for root alone, its name is for all.
    if (!process) process = process_named("screed");
    return PortOwner{process.value_or(Process{}), socket.address};
  }
  return std::nullopt;
}

std::optional<Process> user_of_device(const std::string& device) {
  std::error_code error;
  const std::string target = fs::canonical(device, error);
  if (error) return std::nullopt;
  return process_that([&](const fs::path& folder) { return has_open(folder, target); });
}

Running how_runs(const std::optional<Process>& screed) {
  Running running;
  running.is_running = screed && screed->id > 0;
  if (!running.is_running) return running;
  const fs::path folder = "/proc/" + std::to_string(screed->id);
  std::error_code error;
  for (const auto& thread : fs::directory_iterator(folder / "task", error)) {
    running.has_real_time =
        running.has_real_time || is_real_time(read_text(thread.path() / "stat"));
  }
  const std::string status = read_text(folder / "status");
  const std::string_view locked = status_value(status, "VmLck");
  std::from_chars(locked.data(), locked.data() + locked.size(), running.locked_kilobytes);
  return running;
}

SerialFacts look_at_serial(const std::string& device) {
  SerialFacts facts;
  struct stat status {};
  facts.exists = stat(device.c_str(), &status) == 0;
  if (!facts.exists) return facts;
  std::error_code error;
  const fs::path terminal = fs::canonical(device, error);
  const bool is_pseudo = terminal.string().starts_with("/dev/pts/");
  const fs::path system = fs::path("/sys/class/tty") / terminal.filename();
  facts.is_terminal = S_ISCHR(status.st_mode) && (is_pseudo || fs::exists(system, error));
  facts.may_use = access(device.c_str(), R_OK | W_OK) == 0;
  const group* const owners = getgrgid(status.st_gid);
  facts.group = owners != nullptr ? owners->gr_name : std::to_string(status.st_gid);
  facts.timer_file = system / "device/latency_timer";
  const std::string timer = read_text(facts.timer_file);
  int milliseconds = 0;
  const auto read = std::from_chars(timer.data(), timer.data() + timer.size(), milliseconds);
  if (read.ec == std::errc()) facts.latency_timer = milliseconds;
  return facts;
}

std::optional<CanLink> look_at_can(const std::string& interface) {
  struct {
    nlmsghdr header;
    ifinfomsg interface;
  } request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.interface.ifi_index = static_cast<int>(if_nametoindex(interface.c_str()));
  const Descriptor netlink(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  if (request.interface.ifi_index == 0 || !netlink.is_open() ||
      send(netlink.get(), &request, sizeof request, 0) != sizeof request) {
    return std::nullopt;
  }
  std::array<std::uint8_t, 16384> answer;
  const ssize_t size = recv(netlink.get(), answer.data(), answer.size(), 0);
  return parse_can_link(
      std::span(answer).first(static_cast<std::size_t>(std::max<ssize_t>(size, 0))));
}

std::vector<std::uint32_t> own_addresses() {
  std::vector<std::uint32_t> addresses;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return addresses;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address;
    std::memcpy(&address, each->ifa_addr, sizeof address);
    addresses.push_back(ntohl(address.sin_addr.s_addr));
  }
  freeifaddrs(all);
  return addresses;
}

WireListener::WireListener()
    : socket_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_IP))) {
  constexpr int kBuffer = 8 << 20;
  setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);
}

void WireListener::listen(DatagramCounts& seen) const {
  std::array<std::uint8_t, 2048> buffer;
  while (true) {
    sockaddr_ll sender{};
    socklen_t length = sizeof sender;
    const ssize_t size = recvfrom(socket_.get(), buffer.data(), buffer.size(), MSG_TRUNC,
                                  reinterpret_cast<sockaddr*>(&sender), &length);
    if (size < 0) return;
    // What goes out on the loopback interface comes in there once more.
    if (sender.sll_pkttype == PACKET_OUTGOING) continue;
    const auto original = static_cast<std::size_t>(size);
    const auto packet = std::span(buffer).first(std::min(original, buffer.size()));
    Datagram datagram;
    if (parse_frame(DLT_RAW, packet, original, datagram) != FrameKind::udp) continue;
    if (datagram.payload.size() != velodyne::kDataPacketSize) continue;
    std::uint32_t destination = 0;
    for (const std::uint8_t byte : packet.subspan(16, 4)) destination = destination << 8 | byte;
    ++seen[{datagram.source, destination, datagram.destination_port, datagram.payload.size()}];
  }
}

}  // namespace scree::cli
