#include "read/lidar_file.hpp"

#include <arpa/inet.h>
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
    : reader_(open(capture)),
      size_(std::filesystem::file_size(*lidar_file(capture))),
      data_port_(settings.port),
      position_port_(settings.position_port) {
  in_addr address{};
  const bool is_address = inet_pton(AF_INET, settings.sender.c_str(), &address) == 1;
  if (is_log() && !is_address) channel_ = settings.sender;
}

bool LidarFile::next(Datagram& datagram) {
  return is_log() ? next_of_log(datagram) : std::get<PcapReader>(reader_).next(datagram);
}

bool LidarFile::next_of_log(Datagram& datagram) {
  auto& log = std::get<LcmLogReader>(reader_);
  while (true) {
    const bool is_new = rest_.size() == event_.message.size();
    if (const auto packet = velodyne::take_logged_packet(rest_); !packet.empty()) {
      const bool is_data = packet.size() == velodyne::kDataPacketSize;
      if (is_data && !is_of_my_channel()) continue;
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

/// Mixed, the packets of two sensors make no sweep.
bool LidarFile::is_of_my_channel() {
  if (channel_.empty()) channel_ = event_.channel;
  if (event_.channel == channel_) return true;
  other_channel_ = event_.channel;
  return false;
}

std::string LidarFile::other_channels() const {
  if (other_channel_.empty()) return "";
  return fmt::format(
      "packets of a lidar lie on several channels: those of {} are taken, those of {} "
      "are not; choose a channel with lidar.sender",
      channel_, other_channel_);
}

std::uint64_t LidarFile::position() const {
  return std::visit([](const auto& reader) { return reader.position(); }, reader_);
}

const FrameCounters& LidarFile::frames() const {
  return is_log() ? log_frames_ : std::get<PcapReader>(reader_).frames();
}

std::string LidarFile::broken_off() const {
  return std::visit([](const auto& reader) { return std::string(reader.broken_off()); }, reader_);
}

}  // namespace scree::cli
