#include "publisher_worker.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scree/clock/clocks.hpp"
#include "scree/core/nanoseconds.hpp"

namespace scree {
namespace {

// Health is checked often enough that what stops is published within 300 ms (see HealthWatch).
constexpr std::chrono::milliseconds kCheckInterval{20};
constexpr std::int64_t kHealthIntervalNs = kSecond;
constexpr std::size_t kLongestSentence = 256;  // that takes no memory when it is said
// For the last message, that the robot is blind from now on.
constexpr std::chrono::seconds kEndOfLcm{1};

std::int64_t count(std::uint64_t value) {
  return static_cast<std::int64_t>(value);
}

}  // namespace

PublisherWorker::PublisherWorker(const Settings& settings, const RobotLines& lines,
                                 Publisher publisher, ObstacleListPool& lists, GetStatus get_status,
                                 const ThreadWatchdog& threads, Keeper* keeper)
    : lcm_(LcmSender::start(std::move(publisher),
                            static_cast<std::size_t>(settings.memory.obstacles), keeper)),
      lists_(lists),
      get_status_(std::move(get_status)),
      threads_(threads),
      outputs_(settings.stop, lines),
      watch_(settings, steady_ns()),
      last_health_ns_(steady_ns()) {
  health_.version = SCREE_VERSION;
  sentence_.reserve(kLongestSentence);
  set_zone(settings.stop);
}

void PublisherWorker::run() {
  std::int64_t next_check_ns = steady_ns();
  while (!is_stopped_) {
    loops_.increment();
    const std::int64_t now_ns = steady_ns();
    if (now_ns >= next_check_ns) {
      update_health(now_ns);
      next_check_ns = now_ns + std::chrono::nanoseconds(kCheckInterval).count();
    }
    lists_.wait(kCheckInterval);
    while (TimedObstacleList* timed = lists_.pop()) {
      publish(*timed);
      lists_.release(timed);
    }
  }
  health_.state = health_t::BLIND;
  health_.reason = HealthWatch::kWasStopped;
  const std::int64_t now_ns = steady_ns();
  drive_outputs(now_ns);
  status_ = get_status_();
  publish_health(now_ns);
  if (!lcm_->finish(kEndOfLcm)) spdlog::warn("LCM hangs, the last messages are lost");
}

void PublisherWorker::stop() {
  is_stopped_ = true;
  lists_.wake();
}

std::string PublisherWorker::sentence() {
  const std::scoped_lock lock(sentence_mutex_);
  return sentence_;
}

void PublisherWorker::publish(TimedObstacleList& timed) {
  outputs_.update(timed.list, steady_ns());
  // What was held up on its way is as old as the sensor says.
  const std::int64_t data_ns = std::min(timed.list.stamp_ns, timed.arrival_ns);
  timed.list.stamp_ns = clock_.to_real(timed.list.stamp_ns, read_clocks());
  lcm_->put(timed.list, data_ns);
  statistics_.record(steady_ns() - timed.arrival_ns, timed.detector_ns, timed.report);
  if (timed.grid.empty()) return;
  timed.grid.stamp_ns = timed.list.stamp_ns;
  lcm_->put(timed.grid);
}

void PublisherWorker::take_sent(const LcmSender::Counts& sent) {
  if (count(sent.lists) != health_.lists_published) outputs_.toggle_heartbeat();
  health_.lists_published = count(sent.lists);
  health_.lists_failed = count(sent.failed);
}

void PublisherWorker::update_health(std::int64_t now_ns) {
  outputs_.set_zone(zone_.get());
  status_ = get_status_();
  const LcmSender::Counts sent = lcm_->counts();
  take_sent(sent);
  const DetectorStatus detector{status_.detector_loop_ns,
                                sent.last_list_ns,
                                status_.sweeps_not_covered,
                                statistics_.motion().slips,
                                statistics_.motion().heading_resets,
                                sent.failed + sent.health_failed,
                                statistics_.setup(),
                                statistics_.drops()};
  bool has_changed =
      watch_.update(now_ns, status_.lidar, status_.imu, status_.encoder, detector, health_);
  has_changed = drive_outputs(now_ns) || has_changed;
  for (const auto& [is_warning, text] : watch_.log()) {
    spdlog::log(is_warning ? spdlog::level::warn : spdlog::level::info, text);
  }
  if (has_changed || now_ns - last_health_ns_ >= kHealthIntervalNs) publish_health(now_ns);
}

/// True when what health says of them changed.
bool PublisherWorker::drive_outputs(std::int64_t now_ns) {
  outputs_.set_blind(health_.state == health_t::BLIND, now_ns);
  const bool has_stopped = outputs_.is_stopped(now_ns);
  const bool has_changed =
      health_.stop != has_stopped || health_.lines_problem != outputs_.problem();
  health_.stop = has_stopped ? 1 : 0;
  health_.lines_problem = outputs_.problem();
  return has_changed;
}

void PublisherWorker::publish_health(std::int64_t now_ns) {
  update_sentence();
  health_.stamp_ns = wall_ns();
  fill_counts();
  fill_computer();
  // What found no room is put again with the next check.
  if (lcm_->put(health_)) last_health_ns_ = now_ns;
}

void PublisherWorker::fill_counts() {
  statistics_.fill(health_);
  health_.sweeps = count(status_.lidar.lidar.sweeps);
  health_.sweeps_dropped = count(status_.lidar.sweeps_dropped);
  health_.sweeps_empty = count(status_.lidar.sweeps_empty);
  health_.sweeps_not_covered = count(status_.sweeps_not_covered);
  health_.points_dropped = count(status_.lidar.lidar.dropped + statistics_.drops().points);
  health_.lists_dropped = count(status_.lists_dropped);
  health_.samples_dropped = count(status_.samples_dropped);
  health_.samples_refused = count(status_.samples_refused);
  health_.queues.resize(status_.queues.size());
  for (std::size_t i = 0; i < health_.queues.size(); ++i) {
    const auto& [name, fill] = status_.queues[i];
    health_.queues[i].name = name;
    health_.queues[i].waiting = static_cast<std::int32_t>(fill.waiting);
    health_.queues[i].most = static_cast<std::int32_t>(fill.most);
    health_.queues[i].capacity = static_cast<std::int32_t>(fill.capacity);
  }
  health_.queues_size = static_cast<std::int32_t>(health_.queues.size());
}

void PublisherWorker::fill_computer() {
  health_.threads.clear();
  threads_.for_each_page_faults([this](std::string_view name, const PageFaults& faults) {
    health_.threads.emplace_back();
    health_.threads.back().name = name;
    health_.threads.back().minor_faults = faults.minor;
    health_.threads.back().major_faults = faults.major;
  });
  health_.threads_size = static_cast<std::int32_t>(health_.threads.size());
  health_.processor_temperature = thermometer_.celsius();
}

void PublisherWorker::update_sentence() {
  const std::scoped_lock lock(sentence_mutex_);
  if (health_.state == health_t::BLIND) {
    sentence_ = "blind: ";
    sentence_ += health_.reason;
  } else {
    sentence_ = health_.stop != 0 ? "sees, and says stop" : "sees";
  }
}

}  // namespace scree
