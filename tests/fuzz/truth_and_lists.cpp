// What `scree evaluate` reads: a truth and lists.
#include "commands.hpp"
#include "detection/detections.hpp"
#include "memory_file.hpp"
#include "scoring/truth.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const scree::fuzz::MemoryFile file(bytes, size);
  const auto truth = scree::read_truth(file.name());
  if (truth) truth->pose_at(0);
  try {
    for (const scree::ObstacleList& list : scree::cli::read_detections(file.name())) {
      scree::fuzz::require(list.pose.translation.allFinite());
    }
  } catch (const scree::cli::Failure&) {
  }
  return 0;
}
