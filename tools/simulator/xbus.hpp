#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "scree/drivers/xsens/wire.hpp"

namespace scree {

/// What an MTi measures at one moment, as it sends it.
struct ImuMessage {
  std::int64_t t_ns = 0;  ///< host's time of the measurement
  std::uint16_t packet_counter = 0;
  std::uint32_t sample_time_fine = 0;
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< sensor to east-north-up
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< specific force, sensor's axes, m/s^2
  Eigen::Vector3d rate_of_turn = Eigen::Vector3d::Zero();  ///< sensor's axes, rad/s
  std::uint32_t status = 0;
  bool has_orientation = true;  ///< else it is not sent
};

/// An Xbus message with its checksum. @pre data has at most 254 bytes
std::vector<std::uint8_t> xbus_message(xsens::MessageId id, std::span<const std::uint8_t> data);

/// The MTData2 message of a sample: packet counter, sample time, quaternion (where it has an
/// orientation), acceleration, rate of turn and status word, numbers as float32.
std::vector<std::uint8_t> mt_data2(const ImuMessage& sample);

}  // namespace scree
