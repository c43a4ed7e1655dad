#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "common/progress.hpp"
#include "common/time_span.hpp"
#include "read/host_steps.hpp"
#include "read/lidar_file.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/one_sender.hpp"

namespace scree::cli {

/// The settings of a capture: of `config` when not empty, else of the capture's own scree.toml,
/// else the defaults. Throws Failure.
Settings capture_settings(const std::filesystem::path& capture,
                          const std::filesystem::path& config);

/// What came to which port.
struct PortTraffic {
  std::uint64_t datagrams = 0;
  std::map<std::size_t, std::uint64_t> sizes;      ///< payload bytes, datagrams
  std::map<std::uint32_t, std::uint64_t> senders;  ///< IPv4 address, datagrams
};

/// The lidar's part of a capture, and what was seen of it while it was played.
class LidarCapture {
public:
  /// @param steps taken out of all times
  /// Throws Failure.
  LidarCapture(const std::filesystem::path& capture, const Settings& settings,
               const HostSteps& steps = {});

  using OnDatagram = std::function<void(const Datagram&)>;
  /// Plays the whole file into the stream, as the daemon would receive it, and flushes the stream.
  /// Datagrams that are not the stream's go to `on_other`.
  /// @param before called with the arrival of each datagram before it is taken
  void play(velodyne::LidarStream& stream, const OnDatagram& on_other = {},
            const std::function<void(std::int64_t)>& before = {});

  const std::map<std::uint16_t, PortTraffic>& ports() const { return ports_; }
  const FrameCounters& frames() const { return file_.frames(); }
  /// From the first datagram to the last.
  double seconds() const;
  std::int64_t first_ns() const { return first_ns_; }
  TimeSpan span() const { return {first_ns_, last_ns_}; }
  /// See LidarFile.
  std::string broken_off() const { return file_.broken_off(); }

  /// One sentence where several sensors send to the data port; empty where one does.
  std::string two_senders() const;
  /// One sentence on why no packet was accepted.
  std::string why_nothing(const velodyne::LidarStream& stream) const;

private:
  std::string name_;
  LidarFile file_;
  SteadyTime steady_;
  LidarSettings settings_;
  std::map<std::uint16_t, PortTraffic> ports_;
  velodyne::OneSender senders_;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  std::uint64_t datagrams_ = 0;
};

/// The same as the end of decoding and detecting: what a person should know goes to stderr; throws
/// Failure when no packet was accepted.
void report_capture(const LidarCapture& capture, const velodyne::LidarStream& stream);

/// Sentences about many packets that are missing, and about a lidar that did not turn; empty where
/// there is nothing to say.
std::string missing(const velodyne::LidarCounters& counters);
std::string standing(const velodyne::LidarCounters& counters);

}  // namespace scree::cli
