#include "record/recorders.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "commands.hpp"

namespace scree::cli {
template <class Device, class Open>
bool Recorder::is_open(std::optional<Device>& device, std::int64_t now_ns, Open open) {
  constexpr std::int64_t kRetryAfter = 1'000'000'000;
  if (device) return true;
  if (now_ns < retry_ns_) return false;
  retry_ns_ = now_ns + kRetryAfter;
  auto opened = open();
  if (opened) {
    device.emplace(std::move(*opened));
  } else {
    problem_ = opened.error().message;
  }
  return device.has_value();
}

std::string Recorder::progress() const {
  const double kilobytes = static_cast<double>(bytes_) / 1e3;
  return fmt::format("{} {} {}, {:.1f} {}", name_, count_, unit_,
                     kilobytes < 1e3 ? kilobytes : kilobytes / 1e3, kilobytes < 1e3 ? "kB" : "MB");
}

LidarRecorder::LidarRecorder(const LidarSettings& settings, HostClock& clock)
    : Recorder("lidar", "packets", clock),
      data_(value_or_fail(UdpReceiver::open(settings.address, settings.port, settings.sender))),
      position_(value_or_fail(
          UdpReceiver::open(settings.address, settings.position_port, settings.sender))) {}

void LidarRecorder::create(const std::filesystem::path& file) {
  file_ = value_or_fail(PcapWriter::create_ethernet(file));
}

void LidarRecorder::add_descriptors(std::vector<pollfd>& wait_for) const {
  wait_for.push_back({data_.descriptor(), POLLIN, 0});
  wait_for.push_back({position_.descriptor(), POLLIN, 0});
}

void LidarRecorder::work(std::int64_t now_ns) {
  constexpr std::int64_t kSilence = 2'000'000'000;
  const std::uint64_t before = count();
  read(data_);
  read(position_);
  require(file_->flush());
  if (count() > before || heard_ns_ == 0) heard_ns_ = now_ns;
  const std::uint64_t lost = data_.counts().kernel_drops + position_.counts().kernel_drops;
  problem_.clear();
  if (lost > 0) problem_ = fmt::format("{} packets lost: this computer is too slow", lost);
  if (now_ns - heard_ns_ > kSilence) {
    problem_ = fmt::format("no packets of the lidar on UDP port {}", data_.port());
  }
}

void LidarRecorder::read(UdpReceiver& port) {
  constexpr int kBatch = 64;  // so that the other sensors get their turn
  for (int i = 0; i < kBatch; ++i) {
    const auto received = port.receive(buffer_);
    if (!received) return;
    file_->write({steady(received->arrival_ns), received->sender, received->sender_port,
                  static_cast<std::uint16_t>(port.port()), received->bytes});
    wrote(received->bytes.size());
  }
}

void LidarRecorder::close() {
  require(file_->close());
}

ImuRecorder::ImuRecorder(const ImuSettings& settings, const std::filesystem::path& file,
                         HostClock& clock)
    : Recorder("imu", "reads", clock),
      settings_(settings),
      file_(value_or_fail(PcapWriter::create_serial(file))) {}

void ImuRecorder::add_descriptors(std::vector<pollfd>& wait_for) const {
  wait_for.push_back({device_ ? device_->descriptor() : -1, POLLIN, 0});
}

void ImuRecorder::work(std::int64_t now_ns) {
  if (!is_open(device_, now_ns, [&] { return xsens::Device::open(settings_); })) return;
  while (const auto received = device_->advance(now_ns)) {
    file_.write(steady(received->arrival_ns), received->bytes);
    wrote(received->bytes.size());
  }
  const bool measures = device_->state() == xsens::DeviceState::measuring;
  problem_ = measures ? device_->note() : device_->problem();
  require(file_.flush());
}

void ImuRecorder::close() {
  require(file_.close());
}

CanRecorder::CanRecorder(std::string interface, const std::filesystem::path& file, HostClock& clock)
    : Recorder("can", "frames", clock),
      interface_(std::move(interface)),
      file_(value_or_fail(CanLogWriter::create(file))) {}

void CanRecorder::add_descriptors(std::vector<pollfd>& wait_for) const {
  wait_for.push_back({socket_ ? socket_->descriptor() : -1, POLLIN, 0});
}

void CanRecorder::work(std::int64_t now_ns) {
  if (!is_open(socket_, now_ns, [&] { return encoder::CanSocket::open(interface_); })) return;
  while (auto frame = socket_->receive()) {
    frame->t_ns = steady(frame->t_ns);
    file_.write(*frame, interface_);
    wrote(frame->size);
  }
  require(file_.flush());
  socket_->retry(now_ns);
  // A bus that has been silent since the start shows itself in the count.
  const auto state = static_cast<std::size_t>(socket_->state());
  const bool is_well =
      socket_->state() == encoder::BusState::silent || encoder::kBusStateAdvice[state].empty();
  problem_ = is_well ? ""
                     : fmt::format("CAN bus {} {}, {}", interface_, encoder::kBusStateNames[state],
                                   encoder::kBusStateAdvice[state]);
}

void CanRecorder::close() {
  require(file_.close());
}

}  // namespace scree::cli
