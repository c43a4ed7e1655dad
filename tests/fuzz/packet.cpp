// One datagram of the lidar, of any bytes, as data packet and as position packet.
#include "memory_file.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/position_packet.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace scree::velodyne;
  parse_position_packet({bytes, size});
  static const auto stream =
      std::make_unique<LidarStream>(scree::LidarSettings(), [](scree::Sweep&) {});
  stream->take({bytes, size}, 1'598'612'523'000'000'000);
  stream->take({bytes, size}, 1'598'612'523'001'327'000);
  return 0;
}
