#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "scree/config/settings.hpp"

namespace scree::cli {

/// The host's clock was set while a capture was recorded.
struct HostStep {
  std::int64_t before_ns = 0;  ///< the lidar's last time before it ...
  std::int64_t after_ns = 0;   ///< ... and the first after it
  std::int64_t by_ns = 0;      ///< ahead, or back below zero
};
using HostSteps = std::vector<HostStep>;

/// The steps that the lidar's own clock knows nothing of; a pass over its file. None where no lidar
/// is in the capture to tell of them. Throws Failure where all packets have one time of arrival.
HostSteps find_host_steps(const std::filesystem::path& capture, const LidarSettings& lidar);
/// A line on stderr for each.
void say(const HostSteps& steps);

/// The times of one file's records as they would be if nobody had set the clock. One that goes
/// steadily by itself changes nothing.
class SteadyTime {
public:
  explicit SteadyTime(HostSteps steps = {}) : steps_(std::move(steps)) {}

  /// @param time_ns of one record after the other
  std::int64_t operator()(std::int64_t time_ns);

private:
  HostSteps steps_;
  std::size_t passed_ = 0;
  std::optional<std::int64_t> last_ns_;
  std::int64_t set_by_ns_ = 0;
};

}  // namespace scree::cli
