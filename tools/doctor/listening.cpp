#include "doctor/listening.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <thread>
#include <utility>

#include "scree/core/ipv4.hpp"

namespace scree::cli {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Listening::Listening(const Settings& settings, bool is_screed_running)
    : settings_(settings),
      lidar_stream_(settings.lidar, [](const Sweep&) {}),
      imu_stream_(settings.imu, [](const ImuSample&) {}) {
  lidar_.own_addresses = own_addresses();
  if (wire_.is_open()) lidar_.seen.emplace();
  if (is_screed_running) {
    auto subscriber = Subscriber::open(
        settings.lcm.url, [](const obstacle_list_t&) {},
        [this](const health_t& health) {
          if (!first_health_) first_health_ = health;
          health_ = health;
        });
    if (subscriber) subscriber_ = std::move(*subscriber);
  } else {
    // Packets of any sender count: one that lidar.sender leaves out must be seen to be named.
    auto port = UdpReceiver::open(settings.lidar.address, settings.lidar.port, "");
    if (port) {
      port_ = std::move(*port);
    } else {
      port_problem_ = port.error().message;
    }
    auto position = UdpReceiver::open(settings.lidar.address, settings.lidar.position_port, "");
    if (position) position_port_ = std::move(*position);
    auto imu = xsens::Device::open(settings.imu);
    if (imu) {
      imu_ = std::move(*imu);
    } else {
      imu_problem_ = imu.error().message;
    }
  }
  if (auto can = encoder::CanSocket::open(settings.encoder.interface)) {
    can_ = std::move(*can);
    encoder_.emplace();
  }
}

void Listening::listen(double seconds) {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "listening for {:g} s\n", seconds);
  const auto begin = Clock::now();
  const auto end = begin + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    listen_once(std::chrono::nanoseconds(Clock::now().time_since_epoch()).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  lidar_.seconds = seconds;
  lidar_.packets = lidar_stream_.counters();
  lidar_.without_return_ns = lidar_stream_.without_return_ns();
  if (health_) {
    lidar_.position_packets =
        static_cast<std::uint64_t>(health_->position_packets - first_health_->position_packets);
  }
  if (health_) average_rates();
  if (!encoder_) return;
  encoder_->seconds = seconds;
  if (const auto state = can_->state(); state != encoder::BusState::silent) {
    encoder_->bus_advice = encoder::kBusStateAdvice[static_cast<std::size_t>(state)];
  }
}

void Listening::average_rates() {
  constexpr std::int64_t kLeastNs = 500'000'000;
  const std::int64_t time_ns = health_->stamp_ns - first_health_->stamp_ns;
  if (time_ns < kLeastNs) return;
  for (sensor_health_t health_t::*const sensor : {&health_t::lidar, &health_t::imu}) {
    const std::int64_t messages =
        ((*health_).*sensor).messages - ((*first_health_).*sensor).messages;
    ((*health_).*sensor).rate =
        static_cast<double>(messages) / (static_cast<double>(time_ns) * 1e-9);
  }
}

void Listening::listen_once(std::int64_t now_ns) {
  std::array<std::uint8_t, 4096> buffer;
  while (port_) {
    const auto datagram = port_->receive(buffer);
    if (!datagram) break;
    ++lidar_.heard[{datagram->sender, 0, port_->port(), datagram->bytes.size()}];
    const std::string& wanted = settings_.lidar.sender;
    if (wanted.empty() || ipv4_text(datagram->sender) == wanted) {
      lidar_stream_.take(datagram->bytes, datagram->arrival_ns);
    }
  }
  while (position_port_ && position_port_->receive(buffer)) ++lidar_.position_packets;
  if (lidar_.seen) wire_.listen(*lidar_.seen);
  if (subscriber_) subscriber_->handle(0);
  while (imu_) {
    const auto received = imu_->advance(now_ns);
    if (!received) break;
    imu_stream_.take(received->bytes, received->arrival_ns);
  }
  while (can_) {
    const auto frame = can_->receive();
    if (!frame) break;
    if (frame->is_error) continue;
    const EncoderSettings& wanted = settings_.encoder;
    const auto id = static_cast<std::uint32_t>(wanted.can_id);
    const bool is_wanted = ((frame->id ^ id) & wanted.id_mask()) == 0 &&
                           frame->is_extended == wanted.has_extended_id();
    ++(is_wanted ? encoder_->wanted : encoder_->others);
    if (!is_wanted) encoder_->other_id = frame->id;
  }
  if (can_) can_->retry(now_ns);
}

bool Listening::imu_measures() const {
  return imu_ && imu_->state() == xsens::DeviceState::measuring;
}

Finding Listening::imu() const {
  const std::string subject = "IMU";
  if (!imu_) return wrong(subject, imu_problem_);
  if (!imu_measures()) {
    return wrong(subject, (imu_->problem().empty() ? "it does not answer" : imu_->problem()) +
                              ": check its power and cable, and imu.baud");
  }
  const std::uint64_t messages = imu_stream_.counters().accepted;
  if (messages == 0) {
    return wrong(subject, settings_.imu.device +
                              " is open, but no message of an Xsens MTi comes: "
                              "check imu.baud and imu.configure");
  }
  return ok(subject, fmt::format("it answers and measures, {} messages came", messages));
}

}  // namespace scree::cli
