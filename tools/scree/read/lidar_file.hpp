#pragma once

#include <filesystem>
#include <string>
#include <variant>

#include "scree/capture/lcm_log.hpp"
#include "scree/capture/pcap_reader.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/velodyne/wire.hpp"

namespace scree::cli {

/// The datagrams of a capture's lidar: of a pcap or pcapng file, or of an LCM log whose messages
/// hold packets of the lidar, whatever their channel and type. The first bytes of the file say
/// which it is. Where data packets lie on several channels of a log, those of one are given: of the
/// channel that lidar.sender names, else of the first.
class LidarFile {
public:
  /// @param settings name the ports that packets of a log are taken to have come to
  /// Throws Failure.
  LidarFile(const std::filesystem::path& capture, const LidarSettings& settings);

  /// False at the end. Those of a log have no source, and the time of the logger.
  bool next(Datagram& datagram);

  /// How many bytes of the file were read, and how many it has.
  std::uint64_t position() const;
  std::uint64_t size() const { return size_; }

  /// What was no datagram; in a log `other` counts messages without a packet.
  const FrameCounters& frames() const;
  /// Why the file ended before its end, or what of it is garbled; empty if neither.
  std::string broken_off() const;
  /// One sentence where packets of a log lie on other channels, too; empty where they do not.
  std::string other_channels() const;
  bool is_log() const { return std::holds_alternative<LcmLogReader>(reader_); }

private:
  bool next_of_log(Datagram& datagram);
  bool is_of_my_channel();

  std::variant<PcapReader, LcmLogReader> reader_;
  std::uint64_t size_;
  int data_port_, position_port_;
  LcmEvent event_;
  velodyne::Bytes rest_;  // of the event's message
  FrameCounters log_frames_;
  std::string channel_, other_channel_;  // of the packets that are given, and of others
};

}  // namespace scree::cli
