#include "read/capture_events.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>

#include "commands.hpp"
#include "read/imu_capture.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

std::size_t index_of(Sensor sensor) {
  return static_cast<std::size_t>(sensor);
}

std::int64_t arrival_of(const std::optional<CaptureEvent>& event) {
  return event ? event->arrival_ns : std::numeric_limits<std::int64_t>::max();
}

}  // namespace

CaptureEvents::CaptureEvents(const fs::path& capture, const Settings& settings)
    : interface_(settings.encoder.interface) {
  const auto lidar = lidar_file(capture);
  if (lidar && !fs::is_directory(capture)) {
    lidar_.emplace(capture, settings.lidar);
  } else {
    if (lidar) lidar_.emplace(capture, settings.lidar);
    if (imu_file(capture)) imu_.emplace(open_imu(capture));
    if (const auto can = can_file(capture)) can_.emplace(value_or_fail(CanLogReader::open(*can)));
  }
  if (!lidar_ && !imu_ && !can_) throw Failure(lidar.error().message);
  steady_.fill(SteadyTime(find_host_steps(capture, settings.lidar)));
  for (const Sensor sensor : {Sensor::lidar, Sensor::imu, Sensor::encoder}) {
    waiting_[index_of(sensor)] = read(sensor);
  }
}

bool CaptureEvents::next(CaptureEvent& event) {
  if (handed_out_) waiting_[index_of(*handed_out_)] = read(*handed_out_);
  const auto& first = *std::ranges::min_element(waiting_, {}, arrival_of);
  if (!first) return false;
  event = *first;
  handed_out_ = event.sensor;
  return true;
}

std::optional<CaptureEvent> CaptureEvents::read(Sensor sensor) {
  auto event = read_as_recorded(sensor);
  if (event) event->arrival_ns = steady_[index_of(sensor)](event->arrival_ns);
  return event;
}

std::optional<CaptureEvent> CaptureEvents::read_as_recorded(Sensor sensor) {
  CaptureEvent event;
  event.sensor = sensor;
  if (sensor == Sensor::lidar && lidar_) {
    Datagram datagram;
    if (lidar_->next(datagram)) {
      event.arrival_ns = datagram.arrival_ns;
      event.bytes = datagram.payload;
      event.port = datagram.destination_port;
      return event;
    }
  } else if (sensor == Sensor::imu && imu_) {
    PcapRecord record;
    if (imu_->next(record)) {
      event.arrival_ns = record.arrival_ns;
      event.bytes = record.bytes;
      return event;
    }
  } else if (sensor == Sensor::encoder && can_) {
    std::string interface;
    while (can_->next(event.frame, &interface)) {
      event.arrival_ns = event.frame.t_ns;
      if (interface == interface_) return event;
    }
  }
  return std::nullopt;
}

std::string CaptureEvents::broken_off() const {
  if (lidar_ && !lidar_->broken_off().empty()) return lidar_->broken_off();
  return imu_ ? imu_->broken_off() : "";
}

std::pair<std::int64_t, std::int64_t> span_of(const fs::path& capture, const Settings& settings) {
  CaptureEvents events(capture, settings);
  CaptureEvent event;
  if (!events.next(event)) return {0, 0};
  const std::int64_t first_ns = event.arrival_ns;
  while (events.next(event)) {
  }
  return {first_ns, event.arrival_ns};
}

}  // namespace scree::cli
