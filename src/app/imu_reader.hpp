#pragma once

#include <optional>
#include <string>

#include "event.hpp"
#include "loop_counter.hpp"
#include "scree/clock/host_clock.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/xsens/device.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "sensor_status.hpp"
#include "triple_buffer.hpp"

namespace scree {

/// Keeps the IMU measuring and puts its samples into the buffer, on the monotonic clock. A port
/// that is not there is waited for. run() is the work of a thread; it blocks only in poll(), and
/// says in the log when the device is lost or measures again.
class ImuReader {
public:
  /// Keeps a reference to the buffer.
  ImuReader(const ImuSettings& settings, SyncBuffer& sensors);

  /// Returns after stop() was called from another thread.
  void run();
  void stop() { stop_.wake(); }

  /// For one other thread: what was seen so far.
  const ImuStatus& status() { return shared_status_.get(); }
  const LoopCounter& loops() const { return loops_; }

private:
  void open();
  void read();
  void log_problem(const std::string& problem);

  ImuSettings settings_;
  std::optional<xsens::Device> device_;
  xsens::ImuStream stream_;
  HostClock clock_;
  ImuStatus status_;
  TripleBuffer<ImuStatus> shared_status_;
  bool measures_ = false;
  std::string logged_problem_;
  LoopCounter loops_;
  Event stop_;
};

}  // namespace scree
