// A log of candump. What is read and written again reads the same.
#include "memory_file.hpp"
#include "scree/capture/can_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const scree::fuzz::MemoryFile file(bytes, size);
  auto log = scree::CanLogReader::open(file.name());
  if (!log) return 0;
  std::string interface;
  for (scree::CanFrame frame; log->next(frame, &interface);) {
    scree::fuzz::require(frame.size <= frame.data.size() && !interface.empty());
    scree::fuzz::require(frame.id <= scree::kLargestExtendedId);
  }
  return 0;
}
