#include "encoder_reader.hpp"

#include <poll.h>
#include <spdlog/spdlog.h>

#include <iterator>
#include <utility>

#include "scree/clock/clocks.hpp"

namespace scree {
namespace {

static_assert(kMaxWaitMs <= encoder::CanSocket::kRetryNs / 1'000'000);

}  // namespace

EncoderReader::EncoderReader(const EncoderSettings& settings, SyncBuffer& sensors)
    : settings_(settings),
      stream_(settings, [&sensors](const EncoderSample& sample) { sensors.put(sample); }) {}

void EncoderReader::run() {
  while (true) {
    loops_.increment();
    if (!socket_) open();
    pollfd wait_for[] = {{socket_ ? socket_->descriptor() : -1, POLLIN, 0},
                         {stop_.descriptor(), POLLIN, 0}};
    if (poll(wait_for, std::size(wait_for), kMaxWaitMs) < 0) continue;  // a signal came between
    if (wait_for[1].revents != 0) return;
    if (socket_) read();
  }
}

void EncoderReader::open() {
  auto opened = encoder::CanSocket::open(settings_);
  if (opened) {
    socket_.emplace(std::move(*opened));
    spdlog::info("encoder: listening on {}", settings_.interface);
    return;
  }
  status_.bus = encoder::BusState::absent;
  shared_status_.put(status_);
  if (opened.error().message == logged_problem_) return;
  logged_problem_ = opened.error().message;
  spdlog::warn("encoder: {}", logged_problem_);
}

void EncoderReader::read() {
  while (auto frame = socket_->receive()) {
    frame->t_ns = clock_.to_monotonic(frame->t_ns, read_clocks());
    stream_.take(*frame);
    if (!frame->is_error) status_.last_frame_ns = steady_ns();
    if (stream_.counters().accepted != status_.encoder.accepted) {
      status_.last_sample_ns = status_.last_frame_ns;
    }
    status_.encoder = stream_.counters();
  }
  socket_->retry(steady_ns());
  status_.socket = socket_->counts();
  update_bus(socket_->state());
  shared_status_.put(status_);
}

void EncoderReader::update_bus(encoder::BusState state) {
  if (state == status_.bus) return;
  status_.bus = state;
  const auto index = static_cast<std::size_t>(state);
  const std::string_view advice = encoder::kBusStateAdvice[index];
  spdlog::log(advice.empty() ? spdlog::level::info : spdlog::level::warn, "encoder: bus {}{}{}",
              encoder::kBusStateNames[index], advice.empty() ? "" : ", ", advice);
}

}  // namespace scree
