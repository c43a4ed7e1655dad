#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <span>
#include <thread>

#include "scree/core/descriptor.hpp"
#include "unit/velodyne/packet_builder.hpp"

namespace scree {

/// Sends datagrams to a port of this computer.
class LocalSender {
public:
  explicit LocalSender(int port) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  void operator()(std::span<const std::uint8_t> bytes) const {
    sendto(socket_.get(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
           sizeof to_);
  }

private:
  Descriptor socket_{::socket(AF_INET, SOCK_DGRAM, 0)};
  sockaddr_in to_{};
};

/// A VLP-16 that turns 20 times a second and sends to a port of this computer, until it is
/// destroyed. Its clock begins with it.
class SendingLidar {
public:
  explicit SendingLidar(int port)
      : thread_([this, port](const std::stop_token& stop) { run(stop, port); }) {}

  /// Wall-clock time of the last whole second of its clock.
  std::int64_t last_second_ns() const {
    using std::chrono::nanoseconds;
    const auto seconds = std::chrono::floor<std::chrono::seconds>(Clock::now() - start_);
    return nanoseconds(real_start_.time_since_epoch() + seconds).count();
  }

private:
  using Clock = std::chrono::steady_clock;

  void run(const std::stop_token& stop, int port) const {
    constexpr int kStep = 80;  // hundredths of a degree between two blocks
    const LocalSender send(port);
    velodyne::PacketBuilder packet;
    packet.all_shots(2500, 40);
    for (int i = 0; !stop.stop_requested(); ++i) {
      const std::int64_t due_ns = std::int64_t{i} * velodyne::kPacketNs;
      packet.timestamp(static_cast<std::uint32_t>(due_ns / 1000));
      packet.turn(i * kStep * static_cast<int>(velodyne::kBlocks) % velodyne::kFullTurn, kStep);
      std::this_thread::sleep_until(start_ + std::chrono::nanoseconds(due_ns));
      send(packet.bytes());
    }
  }

  Clock::time_point start_ = Clock::now();
  std::chrono::system_clock::time_point real_start_ = std::chrono::system_clock::now();
  std::jthread thread_;
};

}  // namespace scree
