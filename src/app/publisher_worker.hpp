#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "daemon_status.hpp"
#include "detection_statistics.hpp"
#include "health_watch.hpp"
#include "lcm_sender.hpp"
#include "loop_counter.hpp"
#include "output_lines.hpp"
#include "scree/clock/host_clock.hpp"
#include "scree/publish/publisher.hpp"
#include "thermometer.hpp"
#include "thread_watchdog.hpp"
#include "timed_obstacle_list.hpp"
#include "triple_buffer.hpp"

namespace scree {

class Keeper;

/// Publishes obstacle lists and health and drives the output lines. run() is the work of a thread,
/// and nothing in it blocks but the lines themselves: LCM and the log have threads of their own.
/// Health goes out once a second, and at once when something in it changes.
class PublisherWorker {
public:
  /// The thread of run() calls it.
  using GetStatus = std::function<DaemonStatus()>;

  /// Keeps references to the pool and to the watchdog.
  /// @param threads whose page faults health reports
  /// @param keeper gets what is published; null: nobody does
  PublisherWorker(const Settings& settings, const RobotLines& lines, Publisher publisher,
                  ObstacleListPool& lists, GetStatus get_status, const ThreadWatchdog& threads,
                  Keeper* keeper = nullptr);

  /// Returns after stop() was called from another thread. The last health says that the robot is
  /// blind, and the stop line is set once more.
  void run();
  void stop();

  const LoopCounter& loops() const { return loops_; }
  /// One other thread: the zone of the stop line from now on.
  void set_zone(const StopSettings& zone) { zone_.put(zone); }
  /// Any thread: what the robot sees, or why it does not; one sentence.
  std::string sentence();

private:
  void publish(TimedObstacleList& timed);
  void update_health(std::int64_t now_ns);
  bool drive_outputs(std::int64_t now_ns);
  void take_sent(const LcmSender::Counts& sent);
  void publish_health(std::int64_t now_ns);
  void fill_counts();
  void fill_computer();
  void update_sentence();

  std::shared_ptr<LcmSender> lcm_;
  ObstacleListPool& lists_;
  GetStatus get_status_;
  const ThreadWatchdog& threads_;
  TripleBuffer<StopSettings> zone_;
  HostClock clock_;
  OutputLines outputs_;
  HealthWatch watch_;
  DetectionStatistics statistics_;
  Thermometer thermometer_;
  DaemonStatus status_;
  health_t health_{};
  std::int64_t last_health_ns_;

  std::atomic<bool> is_stopped_{false};
  LoopCounter loops_;
  std::mutex sentence_mutex_;
  std::string sentence_ = "starting";
};

}  // namespace scree
