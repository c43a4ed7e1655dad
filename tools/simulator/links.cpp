#include "simulator/links.hpp"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr std::uint32_t kSensorAddress = 0xC0A801C9;  // 192.168.1.201, as Velodyne ships it
constexpr int kDataPacketsPerPosition = 5;

/// Most of the time about 0.1 ms, seldom a few milliseconds: the host was busy.
std::int64_t delay_ns(Random& random) {
  constexpr double kLeast = 80'000;
  const double usual = random.uniform(0, 150'000);
  const double late = random.chance(0.002) ? random.uniform(0, 4'000'000) : 0;
  return static_cast<std::int64_t>(kLeast + usual + late);
}

}  // namespace

Ethernet::Ethernet(PcapWriter& file, const LidarSettings& lidar, double lost_share,
                   std::uint64_t seed)
    : file_(file), lidar_(lidar), lost_share_(lost_share), random_(seed, 0x317E) {}

void Ethernet::send(const SimulatedLidar& lidar) {
  const auto sent = lidar.packet_end_ns();
  if (!random_.chance(lost_share_)) write(sent, lidar_.port, lidar.data_packet());
  if (++packets_ % kDataPacketsPerPosition != 0) return;
  write(sent + 20'000, lidar_.position_port, lidar.position_packet());
}

void Ethernet::write(std::int64_t sent_ns, int port, std::span<const std::uint8_t> payload) {
  arrival_ns_ = std::max(arrival_ns_ + 1000, sent_ns + delay_ns(random_));
  const auto number = static_cast<std::uint16_t>(port);
  file_.write({arrival_ns_, kSensorAddress, number, number, payload});
}

SerialPort::SerialPort(PcapWriter& file, int baud, std::int64_t burst_ns, std::uint64_t seed)
    : file_(file),
      byte_ns_(1e10 / baud),
      burst_ns_(burst_ns),
      random_(seed, 0x5E41),
      noise_(seed) {}

void SerialPort::send(std::int64_t sent_ns, std::span<const std::uint8_t> bytes) {
  read_until(sent_ns);
  line_free_ns_ = std::max(line_free_ns_, sent_ns);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto taken = static_cast<std::int64_t>(static_cast<double>(i + 1) * byte_ns_);
    receive(line_free_ns_ + taken, bytes[i]);
  }
  const auto taken = static_cast<std::int64_t>(static_cast<double>(bytes.size()) * byte_ns_);
  line_free_ns_ += taken;
}

void SerialPort::receive(std::int64_t t_ns, std::uint8_t byte) {
  arrived_.clear();
  noise_.pass(byte, arrived_);
  for (const std::uint8_t each : arrived_) pending_.push_back({t_ns, each});
}

void SerialPort::read_until(std::int64_t t_ns) {
  while (!pending_.empty()) {
    if (next_read_ns_ == 0) {
      // The port wakes the reader in the middle of a message or after it; a busy host reads late.
      const auto wait = burst_ns_ > 0 ? burst_ns_ - pending_.front().t_ns % burst_ns_
                                      : static_cast<std::int64_t>(random_.uniform(0, 900'000));
      next_read_ns_ = pending_.front().t_ns + wait + delay_ns(random_);
    }
    if (next_read_ns_ > t_ns) return;
    std::vector<std::uint8_t> bytes;
    auto last = pending_.begin();
    for (; last != pending_.end() && last->t_ns <= next_read_ns_; ++last) {
      bytes.push_back(last->byte);
    }
    pending_.erase(pending_.begin(), last);
    read_ns_ = std::max(read_ns_ + 1000, next_read_ns_);
    file_.write(read_ns_, bytes);
    next_read_ns_ = 0;
  }
}

CanBus::CanBus(CanLogWriter& file, const EncoderSettings& encoder, std::uint64_t seed)
    : file_(file), encoder_(encoder), random_(seed, 0xCA4) {}

void CanBus::start(std::int64_t t_ns, double encoder_rate_hz) {
  const auto period = static_cast<std::int64_t>(1e9 / encoder_rate_hz);
  senders_ = {{encoder_.can_id, period, t_ns}};
  for (const std::int64_t id : {0x0C8, 0x3F1, 0x2B0, 0x18FEF100}) {
    if (id == encoder_.can_id) continue;
    const auto other = static_cast<std::int64_t>(random_.uniform(15e6, 900e6));
    senders_.push_back({id, other, t_ns + static_cast<std::int64_t>(random_.uniform(0, 1e7))});
  }
}

void CanBus::run_until(std::int64_t t_ns, SimulatedEncoder& encoder) {
  const auto earlier = [](const Sender& a, const Sender& b) { return a.next_ns < b.next_ns; };
  for (;;) {
    Sender& sender = *std::min_element(senders_.begin(), senders_.end(), earlier);
    if (sender.next_ns > t_ns) return;
    if (&sender == &senders_.front()) {
      const CanData frame = encoder.frame(sender.next_ns);
      if (!is_lost_(sender.next_ns)) log(sender.next_ns, sender.id, frame);
    } else {
      CanData data{};
      for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random_.next());
      log(sender.next_ns, sender.id, data);
    }
    sender.next_ns += sender.period_ns;
  }
}

void CanBus::log(std::int64_t sent_ns, std::int64_t id, const CanData& data) {
  logged_us_ = std::max(logged_us_ + 1, (sent_ns + delay_ns(random_) / 2) / 1000);
  CanFrame frame;
  frame.t_ns = logged_us_ * 1000;
  frame.id = static_cast<std::uint32_t>(id);
  frame.is_extended = frame.id > kLargestStandardId;
  frame.size = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  file_.write(frame, encoder_.interface);
}

}  // namespace scree
