#pragma once

#include <optional>
#include <string>

#include "event.hpp"
#include "loop_counter.hpp"
#include "scree/clock/host_clock.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/encoder/can_socket.hpp"
#include "scree/drivers/encoder/encoder_stream.hpp"
#include "scree/sync/sync_buffer.hpp"
#include "sensor_status.hpp"
#include "triple_buffer.hpp"

namespace scree {

/// Listens to the encoder's bus and puts its samples into the buffer, on the monotonic clock. An
/// interface that is not there is waited for. run() is the work of a thread; it blocks only in
/// poll(), and says in the log when the state of the bus changes.
class EncoderReader {
public:
  /// Keeps a reference to the buffer.
  /// @param settings with what their DBC file says
  EncoderReader(const EncoderSettings& settings, SyncBuffer& sensors);

  /// Returns after stop() was called from another thread.
  void run();
  void stop() { stop_.wake(); }

  /// For one other thread: what was seen so far.
  const EncoderStatus& status() { return shared_status_.get(); }
  const LoopCounter& loops() const { return loops_; }

private:
  void open();
  void read();
  void update_bus(encoder::BusState state);

  EncoderSettings settings_;
  std::optional<encoder::CanSocket> socket_;
  encoder::EncoderStream stream_;
  HostClock clock_;
  EncoderStatus status_;
  TripleBuffer<EncoderStatus> shared_status_;
  std::string logged_problem_;
  LoopCounter loops_;
  Event stop_;
};

}  // namespace scree
