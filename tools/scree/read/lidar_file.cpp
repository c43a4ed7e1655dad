#include "read/lidar_file.hpp"

#include <spdlog/fmt/fmt.h>

#include "commands.hpp"
#include "scree/capture/capture.hpp"
#include "scree/drivers/velodyne/logged_packets.hpp"

namespace scree::cli {
namespace {

std::variant<PcapReader, LcmLogReader> open(const std::filesystem::path& capture) {
  const auto file = value_or_fail(lidar_file(capture));
  if (is_lcm_log(file)) return value_or_fail(LcmLogReader::open(file));
  auto reader = value_or_fail(PcapReader::open(file));
  if (!is_network_link(reader.link_type())) {
    throw Failure(fmt::format("{}: holds no network packets (link type {})", capture.string(),
                              reader.link_type()));
  }
  return reader;
}

}  // namespace

LidarFile::LidarFile(const std::filesystem::path& capture, const LidarSettings& settings)
    : reader_(open(capture)), data_port_(settings.port), position_port_(settings.position_port) {}

bool LidarFile::next(Datagram& datagram) {
  return is_log() ? next_of_log(datagram) : std::get<PcapReader>(reader_).next(datagram);
}

bool LidarFile::next_of_log(Datagram& datagram) {
  auto& log = std::get<LcmLogReader>(reader_);
  while (true) {
    const bool is_new = rest_.size() == event_.message.size();
    if (const auto packet = velodyne::take_logged_packet(rest_); !packet.empty()) {
      const bool is_data = packet.size() == velodyne::kDataPacketSize;
      datagram = {};
      datagram.arrival_ns = event_.arrival_ns;
      datagram.destination_port = static_cast<std::uint16_t>(is_data ? data_port_ : position_port_);
      datagram.payload = packet;
      ++log_frames_.udp;
      return true;
    }
    if (is_new && !event_.message.empty()) ++log_frames_.other;
    if (!log.next(event_)) return false;
    rest_ = event_.message;
  }
}

const FrameCounters& LidarFile::frames() const {
  return is_log() ? log_frames_ : std::get<PcapReader>(reader_).frames();
}

std::string LidarFile::broken_off() const {
  return std::visit([](const auto& reader) { return std::string(reader.broken_off()); }, reader_);
}

}  // namespace scree::cli
