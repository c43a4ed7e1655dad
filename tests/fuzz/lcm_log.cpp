// A log of lcm-logger, and the lidar's packets in its messages.
#include "scree/capture/lcm_log.hpp"
#include "memory_file.hpp"
#include "scree/drivers/velodyne/logged_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const scree::fuzz::MemoryFile file(bytes, size);
  auto log = scree::LcmLogReader::open(file.name());
  if (!log) return 0;
  for (scree::LcmEvent event; log->next(event);) {
    scree::velodyne::Bytes message = event.message;
    while (!message.empty()) {
      const std::size_t before = message.size();
      scree::velodyne::take_logged_packet(message);
      scree::fuzz::require(message.size() < before);
    }
  }
  return 0;
}
