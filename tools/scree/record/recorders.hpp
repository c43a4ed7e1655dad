#pragma once

#include <poll.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scree/capture/can_log.hpp"
#include "scree/capture/pcap_writer.hpp"
#include "scree/clock/clocks.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/encoder/can_socket.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/xsens/device.hpp"

namespace scree::cli {

/// One sensor's part of a recording.
class Recorder {
public:
  /// Keeps a reference to the clock that all of a recording share.
  Recorder(const char* name, const char* unit, HostClock& clock)
      : name_(name), unit_(unit), clock_(clock) {}
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;
  virtual ~Recorder() = default;

  /// What is readable when there is something to write.
  virtual void add_descriptors(std::vector<pollfd>& wait_for) const = 0;
  /// Writes what has come, all of it into the file at once, and looks after a sensor that is
  /// missing. Throws Failure where the file cannot be written.
  virtual void work(std::int64_t now_ns) = 0;
  virtual void close() = 0;

  /// "lidar 9048 packets, 11.4 MB"
  std::string progress() const;
  /// What a person has to do now, one sentence; mostly empty.
  const std::string& problem() const { return problem_; }
  std::uint64_t count() const { return count_; }

protected:
  void wrote(std::size_t bytes) {
    ++count_;
    bytes_ += bytes;
  }
  /// What is written of a sensor's wall-clock stamp: the host's clock may be set meanwhile.
  std::int64_t steady(std::int64_t stamp_ns) {
    return clock_.to_first_real(stamp_ns, read_clocks());
  }
  /// Whether it is there; where it is missing it is tried once a second.
  template <class Device, class Open>
  bool is_open(std::optional<Device>& device, std::int64_t now_ns, Open open);

  std::string problem_;

private:
  const char* name_;
  const char* unit_;
  HostClock& clock_;
  std::uint64_t count_ = 0, bytes_ = 0;
  std::int64_t retry_ns_ = 0;
};

/// The datagrams of the data and of the position port, as frames.
class LidarRecorder final : public Recorder {
public:
  /// Opens the ports; throws Failure where another program has them.
  LidarRecorder(const LidarSettings& settings, HostClock& clock);

  /// Throws Failure.
  void create(const std::filesystem::path& file);
  void add_descriptors(std::vector<pollfd>& wait_for) const override;
  void work(std::int64_t now_ns) override;
  void close() override;

private:
  void read(UdpReceiver& port);

  UdpReceiver data_, position_;
  std::int64_t heard_ns_ = 0;  // when packets came last, or it began
  std::optional<PcapWriter> file_;
  std::array<std::uint8_t, 65536> buffer_{};
};

/// What each read from the IMU's port brings, once it measures.
class ImuRecorder final : public Recorder {
public:
  ImuRecorder(const ImuSettings& settings, const std::filesystem::path& file, HostClock& clock);

  void add_descriptors(std::vector<pollfd>& wait_for) const override;
  void work(std::int64_t now_ns) override;
  void close() override;

private:
  ImuSettings settings_;
  PcapWriter file_;
  std::optional<xsens::Device> device_;
};

/// Every frame of the encoder's CAN interface, of whatever device.
class CanRecorder final : public Recorder {
public:
  CanRecorder(std::string interface, const std::filesystem::path& file, HostClock& clock);

  void add_descriptors(std::vector<pollfd>& wait_for) const override;
  void work(std::int64_t now_ns) override;
  void close() override;

private:
  std::string interface_;
  CanLogWriter file_;
  std::optional<encoder::CanSocket> socket_;
};

}  // namespace scree::cli
