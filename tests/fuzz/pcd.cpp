// A point cloud: header, body as text, binary or compressed.
#include "scree/capture/pcd.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const scree::fuzz::MemoryFile file(bytes, size);
  scree::is_pcd(file.name());
  const auto cloud = scree::read_pcd(file.name());
  scree::fuzz::require(cloud.has_value() || !cloud.error().message.empty());
  return 0;
}
