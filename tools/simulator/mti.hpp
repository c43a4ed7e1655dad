#pragma once

#include <cstdint>
#include <vector>

#include "scree/drivers/xsens/framing.hpp"

namespace scree {

/// The device's side of an MTi's start (MT0101P, "States"): requests in, answers out. It takes on
/// whatever it is asked for, and measures from its power-on until it is told to be configured.
class SimulatedMti {
public:
  /// Bytes of the host, split and joined anywhere. @return what the device answers
  std::vector<std::uint8_t> take(xsens::Bytes bytes);

  bool is_measuring() const { return is_measuring_; }

private:
  std::vector<std::uint8_t> answer(const xsens::Message& request);

  xsens::Framer framer_;
  bool is_measuring_ = true;
};

}  // namespace scree
