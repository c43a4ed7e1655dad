#pragma once

#include <string>

#include "common/outputs.hpp"

namespace scree::cli {

struct DecodeOptions {
  std::string capture, config, sensor, out, pcd;
  Outputs outputs;
};

// One file a sensor. Each writes the decoded values as CSV, then says on stderr what a person
// should know of the capture; throws Failure when nothing could be decoded.

void decode_encoder(const DecodeOptions& options);
void decode_imu(const DecodeOptions& options);
void decode_lidar(const DecodeOptions& options);

}  // namespace scree::cli
