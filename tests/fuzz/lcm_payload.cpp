// The bytes of one message on each of our channels.
#include <string_view>

#include "memory_file.hpp"
#include "scree/publish/message_decoder.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/publisher.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  scree::ObstacleList list;
  scree::MessageDecoder decoder(
      [&](const scree::obstacle_list_t& message) { from_message(message, list); },
      [](const scree::health_t&) {}, [](const scree::grid_t&) {});
  for (const std::string_view channel :
       {scree::kObstaclesChannel, scree::kHealthChannel, scree::kGridChannel}) {
    decoder.take(channel, {bytes, size});
  }
  return 0;
}
