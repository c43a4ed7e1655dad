#include "scree/app/daemon.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "detection_statistics.hpp"
#include "encoder_reader.hpp"
#include "health_watch.hpp"
#include "imu_reader.hpp"
#include "lidar_reader.hpp"
#include "output_lines.hpp"
#include "page_faults.hpp"
#include "real_time.hpp"
#include "scree/app/motion_wait.hpp"
#include "scree/publish/publisher.hpp"
#include "scree/sync/clocks.hpp"
#include "spsc_pool.hpp"
#include "thermometer.hpp"
#include "thread_watchdog.hpp"
#include "timed_obstacle_list.hpp"
#include "triple_buffer.hpp"

namespace scree {
namespace {

// One sweep in work and two that wait: enough for a slow one, and never more than 0.3 s old at 10
// Hz.
constexpr std::size_t kSweeps = 3;
constexpr std::size_t kLists = 4;
constexpr std::chrono::milliseconds kLook{20};  // how often health is looked at
constexpr std::int64_t kReport = 1'000'000'000;

class Threads final : public Daemon {
public:
  Threads(const Settings& settings, SweepProcessor process, SyncBuffer* sensors,
          const RobotLines& lines, LidarPorts ports, Publisher publisher)
      : sweeps_(kSweeps, [] { return TimedSweep(); }),
        lists_(kLists, [&] { return TimedObstacleList(max_obstacles(settings)); }),
        reader_(settings.lidar, std::move(ports), lines.pps, sweeps_),
        process_(std::move(process)),
        sensors_(sensors),
        publisher_(std::move(publisher)),
        outputs_(settings.stop, lines),
        watch_(settings, steady_ns()) {
    health_.version = SCREE_VERSION;
    if (sensors_ != nullptr) wait_.emplace(*sensors_, settings.map.wait);
    Threads::apply(settings);
    if (sensors_ != nullptr) {
      imu_.emplace(settings.imu, *sensors_);
      encoder_.emplace(settings.encoder, *sensors_);
      reading_imu_ = run("imu", imu_->loops(), [this] { imu_->run(); });
      reading_encoder_ = run("encoder", encoder_->loops(), [this] { encoder_->run(); });
    }
    reading_ = run("lidar", reader_.loops(), [this] { reader_.run(); });
    detecting_ = run("detector", detected_, [this] { detect(); });
    publishing_ = run("publisher", published_, [this] { publish(); });
    run_first({&reading_, &reading_imu_, &reading_encoder_});
  }

  ~Threads() override {
    stop_ = true;
    reader_.stop();
    sweeps_.wake();
    lists_.wake();
    for (std::thread* thread : {&reading_, &detecting_, &publishing_}) thread->join();
    if (sensors_ == nullptr) return;
    imu_->stop();
    encoder_->stop();
    reading_imu_.join();
    reading_encoder_.join();
  }

  std::string_view stalled_thread() override { return watchdog_.stalled(); }

  void apply(const Settings& settings) override {
    zone_.put(settings.stop);
    if (wait_) wait_->set_limit(settings.map.wait);
  }

  std::string status() override {
    const std::scoped_lock lock(status_mutex_);
    return status_;
  }

  static std::size_t max_obstacles(const Settings& settings) {
    return static_cast<std::size_t>(settings.memory.obstacles);
  }

private:
  template <class Body>
  std::thread run(const char* name, const LoopCounter& loops, Body body) {
    watchdog_.add(name, loops);
    std::thread thread(body);
    pthread_setname_np(thread.native_handle(), name);  // as `top -H` shows it
    return thread;
  }

  void detect() {
    while (!stop_) {
      go_round();
      sweeps_.wait(kLook);
      // Without sweeps too, so that the sensors' rings do not fill.
      if (sensors_ != nullptr) sensors_->gather();
      while (TimedSweep* sweep = stop_ ? nullptr : sweeps_.pop()) {
        wait_for_motion(*sweep);
        detect(*sweep);
        sweeps_.release(sweep);
        go_round();
      }
    }
  }

  void go_round() {
    detected_.increment();
    last_round_ns_.store(steady_ns(), std::memory_order_relaxed);
  }

  void wait_for_motion(const TimedSweep& sweep) {
    constexpr std::chrono::milliseconds kPause{1};
    while (wait_ && !stop_) {
      go_round();
      if (wait_->is_over(sweep.sweep.end_ns, sweep.arrival_ns, steady_ns())) return;
      std::this_thread::sleep_for(kPause);
    }
  }

  void detect(const TimedSweep& sweep) {
    DetectionReport report;
    const std::int64_t begin = steady_ns();
    const ObstacleList* list = process_(sweep.sweep, report);
    const std::int64_t end = steady_ns();
    if (list == nullptr) return;
    TimedObstacleList* found = lists_.acquire();
    if (found == nullptr) {
      lists_dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    found->copy_from(*list);
    found->arrival_ns = sweep.arrival_ns;
    found->detector_ns = end - begin;
    found->report = report;
    lists_.push(found);
  }

  void publish() {
    std::int64_t next_look = steady_ns();
    while (!stop_) {
      published_.increment();
      const std::int64_t now = steady_ns();
      if (now >= next_look) {
        look(now);
        next_look = now + std::chrono::nanoseconds(kLook).count();
      }
      lists_.wait(kLook);
      while (TimedObstacleList* found = lists_.pop()) {
        publish(*found);
        lists_.release(found);
      }
    }
    health_.state = health_t::BLIND;
    health_.reason = "screed was stopped";
    const std::int64_t now = steady_ns();
    drive_outputs(now);
    report(now);
  }

  void publish(TimedObstacleList& found) {
    outputs_.see(found.list, steady_ns());
    found.list.stamp_ns = clock_.to_real(found.list.stamp_ns, read_clocks());
    const bool is_taken = publisher_.publish(found.list);
    const std::int64_t now = steady_ns(), latency_ns = now - found.arrival_ns;
    statistics_.record(latency_ns, found.detector_ns, found.report);
    ++(is_taken ? health_.lists_published : health_.lists_failed);
    if (!is_taken) return;
    outputs_.beat();
    if (latency_ns <= HealthWatch::kOldSweep) last_list_ns_ = now;
  }

  void look(std::int64_t now) {
    outputs_.set_zone(zone_.get());
    const LidarStatus& lidar = reader_.status();
    const DetectorStatus detector{last_round_ns_.load(std::memory_order_relaxed), last_list_ns_,
                                  (wait_ ? wait_->not_covered() : 0), statistics_.motion().slips,
                                  statistics_.motion().heading_resets};
    bool has_changed =
        watch_.update(now, lidar, imu_ ? imu_->status() : ImuStatus(),
                      encoder_ ? encoder_->status() : EncoderStatus(), detector, health_);
    has_changed = drive_outputs(now) || has_changed;
    for (const auto& [is_warning, text] : watch_.log()) {
      spdlog::log(is_warning ? spdlog::level::warn : spdlog::level::info, text);
    }
    if (has_changed || now - last_report_ns_ >= kReport) report(now);
  }

  void say_status() {
    std::string status = health_.state == health_t::BLIND ? "blind: " + health_.reason
                         : health_.stop != 0              ? "sees, and says stop"
                                                          : "sees";
    const std::scoped_lock lock(status_mutex_);
    status_ = std::move(status);
  }

  /// True when what health says of them changed.
  bool drive_outputs(std::int64_t now) {
    outputs_.set_blind(health_.state == health_t::BLIND, now);
    const bool has_stopped = outputs_.is_stopped(now);
    const bool has_changed =
        health_.stop != has_stopped || health_.lines_problem != outputs_.problem();
    health_.stop = has_stopped ? 1 : 0;
    health_.lines_problem = outputs_.problem();
    return has_changed;
  }

  void report(std::int64_t now) {
    say_status();
    health_.stamp_ns = wall_ns();
    fill_counts();
    fill_computer();
    if (!publisher_.publish(health_)) spdlog::warn("LCM does not take the health message");
    last_report_ns_ = now;
  }

  void fill_counts() {
    const auto count = [](std::uint64_t value) { return static_cast<std::int64_t>(value); };
    const LidarStatus& lidar = reader_.status();
    statistics_.fill(health_);
    health_.sweeps = count(lidar.lidar.sweeps);
    health_.sweeps_dropped = count(lidar.sweeps_dropped);
    health_.sweeps_empty = count(lidar.sweeps_empty);
    health_.sweeps_not_covered = count((wait_ ? wait_->not_covered() : 0));
    health_.points_dropped = count(lidar.lidar.dropped + statistics_.drops().points);
    health_.lists_dropped = lists_dropped_.load(std::memory_order_relaxed);
    health_.queues = {queue_message("sweeps", sweeps_.fill()),
                      queue_message("lists", lists_.fill())};
    if (sensors_ != nullptr) {
      health_.samples_dropped = count(sensors_->dropped());
      health_.samples_refused = count(sensors_->late());
      health_.queues.push_back(queue_message("imu", sensors_->imu_fill()));
      health_.queues.push_back(queue_message("encoder", sensors_->wheel_fill()));
    }
    health_.queues_size = static_cast<std::int32_t>(health_.queues.size());
  }

  void fill_computer() {
    health_.threads.clear();
    for (const PageFaults& faults : page_faults()) {
      if (!watchdog_.watches(faults.thread)) continue;
      health_.threads.push_back({faults.thread, faults.minor, faults.major});
    }
    health_.threads_size = static_cast<std::int32_t>(health_.threads.size());
    health_.processor_temperature = thermometer_.celsius();
  }

  std::atomic<bool> stop_{false};
  SweepPool sweeps_;
  SpscPool<TimedObstacleList> lists_;
  std::atomic<std::int64_t> lists_dropped_{0}, last_round_ns_{steady_ns()};
  LidarReader reader_;
  std::optional<ImuReader> imu_;
  std::optional<EncoderReader> encoder_;
  SweepProcessor process_;
  SyncBuffer* sensors_;
  std::optional<MotionWait> wait_;
  TripleBuffer<StopSettings> zone_;

  // Of the publishing thread alone.
  Publisher publisher_;
  HostClock clock_;
  OutputLines outputs_;
  HealthWatch watch_;
  health_t health_{};
  DetectionStatistics statistics_;
  Thermometer thermometer_;
  std::int64_t last_list_ns_ = 0, last_report_ns_ = steady_ns();

  ThreadWatchdog watchdog_;
  LoopCounter detected_, published_;
  std::mutex status_mutex_;
  std::string status_ = "starting";
  std::thread reading_, reading_imu_, reading_encoder_, detecting_, publishing_;
};

}  // namespace

Result<std::unique_ptr<Daemon>> Daemon::start(const Settings& settings, SweepProcessor process,
                                              SyncBuffer* sensors, const RobotLines& lines) {
  auto ports = LidarPorts::open(settings.lidar);
  if (!ports) return tl::make_unexpected(ports.error());
  auto publisher = Publisher::open(settings.lcm.url, Threads::max_obstacles(settings));
  if (!publisher) return tl::make_unexpected(publisher.error());
  spdlog::info("listening on {}, UDP port {} for data and {} for position packets, from {}",
               settings.lidar.address, ports->data.port(), ports->position.port(),
               settings.lidar.sender.empty() ? "any sender" : settings.lidar.sender);
  spdlog::info("publishing on {}", settings.lcm.url);
  return std::make_unique<Threads>(settings, std::move(process), sensors, lines, std::move(*ports),
                                   std::move(*publisher));
}

}  // namespace scree
