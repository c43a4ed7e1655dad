#include "imu_reader.hpp"

#include <poll.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "scree/clock/clocks.hpp"

namespace scree {
namespace {

int milliseconds_until(std::int64_t due_ns) {
  const std::int64_t left_ns = due_ns - steady_ns();
  return static_cast<int>(std::clamp<std::int64_t>(left_ns / 1'000'000 + 1, 0, kMaxWaitMs));
}

}  // namespace

ImuReader::ImuReader(const ImuSettings& settings, SyncBuffer& sensors)
    : settings_(settings),
      stream_(settings, [&sensors](const ImuSample& sample) { sensors.put(sample); }) {}

void ImuReader::run() {
  while (true) {
    loops_.increment();
    if (!device_) open();
    pollfd wait_for[] = {{device_ ? device_->descriptor() : -1, POLLIN, 0},
                         {stop_.descriptor(), POLLIN, 0}};
    const int longest = device_ ? milliseconds_until(device_->due_ns()) : kMaxWaitMs;
    if (poll(wait_for, std::size(wait_for), longest) < 0) continue;  // a signal came between
    if (wait_for[1].revents != 0) return;
    if (device_) read();
  }
}

void ImuReader::open() {
  auto opened = xsens::Device::open(settings_);
  if (opened) {
    device_.emplace(std::move(*opened));
  } else {
    log_problem(opened.error().message);
  }
}

void ImuReader::read() {
  while (const auto received = device_->advance(steady_ns())) {
    stream_.take(received->bytes, clock_.to_monotonic(received->arrival_ns, read_clocks()));
    const xsens::ImuCounters& counters = stream_.counters();
    const std::int64_t now_ns = steady_ns();
    // The answers to the start-up are no data that could be wrong.
    const bool is_answer = counters.other_messages != status_.imu.other_messages &&
                           counters.accepted == status_.imu.accepted;
    if (!is_answer) status_.last_bytes_ns = now_ns;
    if (counters.useful != status_.imu.useful) status_.last_message_ns = now_ns;
    status_.imu = counters;
  }
  status_.clock = stream_.clock().status(wall_ns() - steady_ns());
  shared_status_.put(status_);
  const bool measures = device_->state() == xsens::DeviceState::measuring;
  if (measures && !measures_) {
    spdlog::info("IMU: measuring on {}", settings_.device);
    if (!device_->note().empty()) spdlog::warn("IMU: {}", device_->note());
    logged_problem_.clear();
  } else if (!measures) {
    log_problem(device_->problem());
  }
  measures_ = measures;
}

void ImuReader::log_problem(const std::string& problem) {
  if (problem.empty() || problem == logged_problem_) return;
  spdlog::warn("IMU: {}", problem);
  logged_problem_ = problem;
}

}  // namespace scree
