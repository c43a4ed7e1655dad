#pragma once

#include <memory>
#include <optional>
#include <string>

#include "doctor/can_link.hpp"
#include "doctor/lidar_traffic.hpp"
#include "doctor/probes.hpp"
#include "scree/config/settings.hpp"
#include "scree/drivers/encoder/can_socket.hpp"
#include "scree/drivers/velodyne/lidar_stream.hpp"
#include "scree/drivers/velodyne/udp_receiver.hpp"
#include "scree/drivers/xsens/device.hpp"
#include "scree/drivers/xsens/imu_stream.hpp"
#include "scree/publish/subscriber.hpp"

namespace scree::cli {

/// Listens to all sensors at once: what screed does not hold is opened here, and of the rest its
/// health tells.
class Listening {
public:
  Listening(const Settings& settings, bool is_screed_running);
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;

  void listen(double seconds);

  /// Why the lidar's port cannot be opened; empty where it was, or screed has it.
  const std::string& port_problem() const { return port_problem_; }
  const LidarTraffic& lidar() const { return lidar_; }
  /// The last health of screed, with rates over the whole time; nothing where none came.
  const std::optional<health_t>& health() const { return health_; }
  bool imu_measures() const;
  Finding imu() const;
  /// Nothing where its interface cannot be opened.
  const std::optional<CanTraffic>& encoder() const { return encoder_; }

private:
  void listen_once(std::int64_t now_ns);
  void average_rates();

  const Settings& settings_;
  LidarTraffic lidar_;
  std::optional<UdpReceiver> port_, position_port_;
  velodyne::LidarStream lidar_stream_;
  std::string port_problem_;
  WireListener wire_;
  std::unique_ptr<Subscriber> subscriber_;
  std::optional<health_t> first_health_, health_;
  std::optional<xsens::Device> imu_;
  std::string imu_problem_;
  xsens::ImuStream imu_stream_;
  std::optional<encoder::CanSocket> can_;
  std::optional<CanTraffic> encoder_;
};

}  // namespace scree::cli
