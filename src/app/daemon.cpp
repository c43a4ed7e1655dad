#include "scree/app/daemon.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <initializer_list>
#include <optional>
#include <thread>
#include <utility>

#include "detector_worker.hpp"
#include "encoder_reader.hpp"
#include "imu_reader.hpp"
#include "keeper.hpp"
#include "lidar_reader.hpp"
#include "publisher_worker.hpp"
#include "real_time.hpp"

namespace scree {
namespace {

// One sweep in work and two that wait: enough for a slow one, and never more than 0.3 s old at 10
// turns a second.
constexpr std::size_t kSweeps = 3;
// One list more than sweeps, so that a list finds room while the publisher works on another.
constexpr std::size_t kLists = 4;

/// Sweeps of these settings that may wait: the parts of a turn besides.
std::size_t most_sweeps(const Settings& settings) {
  return kSweeps + static_cast<std::size_t>(settings.detect.lists_per_turn - 1);
}

std::size_t max_obstacles(const Settings& settings) {
  return static_cast<std::size_t>(settings.memory.obstacles);
}

class ThreadedDaemon final : public Daemon {
public:
  ThreadedDaemon(const Settings& settings, SweepProcessor process, SyncBuffer* sensors,
                 const RobotLines& lines, LidarPorts ports, Publisher publisher,
                 std::unique_ptr<Keeper> keeper)
      : sensors_(sensors),
        keeper_(std::move(keeper)),
        sweeps_(most_sweeps(settings), [] { return TimedSweep(); }),
        lists_(kLists, [&] { return TimedObstacleList(max_obstacles(settings)); }),
        lidar_(settings, std::move(ports), lines.pps, sweeps_, keeper_.get()),
        detector_(std::move(process), sensors, settings.motion_wait(), sweeps_, lists_),
        publisher_(
            settings, lines, std::move(publisher), lists_, [this] { return collect_status(); },
            watchdog_, keeper_.get()) {
    if (sensors_ == nullptr) return;
    if (!settings.imu.device.empty()) imu_.emplace(settings.imu, *sensors_);
    if (!settings.encoder.interface.empty()) encoder_.emplace(settings.encoder, *sensors_);
  }

  /// Where a thread cannot be started, those before are stopped by the destructor.
  /// @throw std::system_error
  void start_threads() {
    if (imu_) imu_thread_ = start_thread("imu", *imu_);
    if (encoder_) encoder_thread_ = start_thread("encoder", *encoder_);
    lidar_thread_ = start_thread("lidar", lidar_);
    detector_thread_ = start_thread("detector", detector_);
    publisher_thread_ = start_thread("publisher", publisher_);
    run_first({&lidar_thread_, &imu_thread_, &encoder_thread_});
  }

  ~ThreadedDaemon() override {
    lidar_.stop();
    detector_.stop();
    publisher_.stop();
    join({&lidar_thread_, &detector_thread_, &publisher_thread_});
    // After the publisher, which asks both for their status.
    if (imu_) imu_->stop();
    if (encoder_) encoder_->stop();
    join({&imu_thread_, &encoder_thread_});
  }

  std::string_view stalled_thread() override { return watchdog_.stalled(); }

  void apply(const Settings& settings) override {
    publisher_.set_zone(settings.stop);
    detector_.set_max_wait(settings.motion_wait());
  }

  std::string status() override { return publisher_.sentence(); }

private:
  template <class Worker>
  std::thread start_thread(const char* name, Worker& worker) {
    ThreadPageFaults& page_faults = watchdog_.add(name, worker.loops());
    std::thread thread([&worker, &page_faults] {
      page_faults.open();
      worker.run();
    });
    pthread_setname_np(thread.native_handle(), name);  // as `top -H` shows it
    return thread;
  }

  static void join(std::initializer_list<std::thread*> threads) {
    for (std::thread* thread : threads) {
      if (thread->joinable()) thread->join();
    }
  }

  DaemonStatus collect_status() {
    DaemonStatus status;
    status.lidar = lidar_.status();
    status.lidar.sweeps_dropped += detector_.sweeps_skipped();
    status.lidar.parts_dropped += detector_.parts_skipped();
    status.detector_loop_ns = detector_.last_loop_ns();
    status.sweeps_not_covered = detector_.not_covered();
    status.lists_dropped = detector_.lists_dropped();
    status.queues = {{"sweeps", sweeps_.fill()}, {"lists", lists_.fill()}};
    if (sensors_ == nullptr) return status;
    if (imu_) status.imu = imu_->status();
    if (encoder_) status.encoder = encoder_->status();
    status.samples_dropped = sensors_->dropped();
    status.samples_refused = sensors_->late();
    status.queues.push_back({"imu", sensors_->imu_fill()});
    status.queues.push_back({"encoder", sensors_->wheel_fill()});
    return status;
  }

  SyncBuffer* sensors_;
  std::unique_ptr<Keeper> keeper_;  // ends after those that it keeps from
  SweepPool sweeps_;
  ObstacleListPool lists_;
  ThreadWatchdog watchdog_;
  LidarReader lidar_;
  std::optional<ImuReader> imu_;
  std::optional<EncoderReader> encoder_;
  DetectorWorker detector_;
  PublisherWorker publisher_;
  std::thread lidar_thread_, imu_thread_, encoder_thread_, detector_thread_, publisher_thread_;
};

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::start(const Settings& settings, SweepProcessor process,
                                              SyncBuffer* sensors, const RobotLines& lines) {
  auto ports = LidarPorts::open(settings.lidar);
  if (!ports) return tl::make_unexpected(ports.error());
  auto publisher = Publisher::open(settings.lcm.url);
  if (!publisher) return tl::make_unexpected(publisher.error());
  auto keeper = Keeper::start(settings);
  if (!keeper) return tl::make_unexpected(keeper.error());
  spdlog::info("listening on {}, UDP port {} for data and {} for position packets, from {}",
               settings.lidar.address, ports->data.port(), ports->position.port(),
               settings.lidar.sender.empty() ? "any sender" : settings.lidar.sender);
  spdlog::info("publishing on {}", settings.lcm.url);
  auto daemon = std::make_unique<ThreadedDaemon>(settings, std::move(process), sensors, lines,
                                                 std::move(*ports), std::move(*publisher),
                                                 std::move(*keeper));
  daemon->start_threads();
  return daemon;
}

}  // namespace scree
