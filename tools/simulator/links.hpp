#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "scree/capture/can_log.hpp"
#include "scree/capture/pcap_writer.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/random.hpp"
#include "simulator/byte_noise.hpp"
#include "simulator/encoder.hpp"
#include "simulator/lidar.hpp"

// What lies between the sensors and the host: delays, losses, and how bytes are cut into pieces.
namespace scree {

/// The lidar's datagrams as the host receives them: a moment after they were sent, now and then a
/// few milliseconds, never out of order; some get lost. Every fifth data packet is followed by a
/// position packet.
class Ethernet {
public:
  /// Keeps a reference to the file.
  Ethernet(PcapWriter& file, const LidarSettings& lidar, double lost_share, std::uint64_t seed);
  void send(const SimulatedLidar& lidar);

private:
  void write(std::int64_t sent_ns, int port, std::span<const std::uint8_t> payload);

  PcapWriter& file_;
  LidarSettings lidar_;
  double lost_share_;
  Random random_;
  std::int64_t arrival_ns_ = 0;
  int packets_ = 0;
};

/// A serial port: the host reads what has come since it last read, which splits and joins messages
/// anywhere.
class SerialPort {
public:
  /// Keeps a reference to the file.
  /// @param burst_ns every so long an USB adapter hands on what it has; 0: as it comes
  SerialPort(PcapWriter& file, int baud, std::int64_t burst_ns, std::uint64_t seed);

  /// From now on this share of bytes is disturbed.
  void corrupt(double share) { noise_.set_share(share); }
  /// @param sent_ns when the device began to send; not before that of the message before
  void send(std::int64_t sent_ns, std::span<const std::uint8_t> bytes);
  /// Reads the rest.
  void finish() { read_until(INT64_MAX); }

private:
  void read_until(std::int64_t t_ns);
  void receive(std::int64_t t_ns, std::uint8_t byte);

  PcapWriter& file_;
  double byte_ns_;
  std::int64_t burst_ns_;
  Random random_;
  ByteNoise noise_;
  std::vector<std::uint8_t> arrived_;  // of one byte
  struct Pending {
    std::int64_t t_ns;
    std::uint8_t byte;
  };
  std::vector<Pending> pending_;
  std::int64_t line_free_ns_ = 0, next_read_ns_ = 0, read_ns_ = 0;
};

/// A CAN bus as `candump -L` logs it: the encoder's frames and those of other devices.
class CanBus {
public:
  /// Keeps a reference to the file.
  CanBus(CanLogWriter& file, const EncoderSettings& encoder, std::uint64_t seed);

  /// The encoder's frames are not logged where this says so of the time at which they are sent.
  void lose_encoder(std::function<bool(std::int64_t t_ns)> is_lost) {
    is_lost_ = std::move(is_lost);
  }
  /// Logs all that is sent up to a time.
  void run_until(std::int64_t t_ns, SimulatedEncoder& encoder);
  void start(std::int64_t t_ns, double encoder_rate_hz);

private:
  struct Sender {
    std::int64_t id, period_ns, next_ns;
  };
  void log(std::int64_t sent_ns, std::int64_t id, const CanData& data);

  CanLogWriter& file_;
  EncoderSettings encoder_;
  Random random_;
  std::vector<Sender> senders_;  // the first is the encoder
  std::function<bool(std::int64_t)> is_lost_ = [](std::int64_t) { return false; };
  std::int64_t logged_us_ = 0;
};

}  // namespace scree
