#pragma once

#include <filesystem>
#include <vector>

#include "scree/core/descriptor.hpp"

namespace scree {

/// Reads the temperature of the processor where the kernel says it: in a thermal zone (Raspberry
/// Pi, Jetson, Intel) or a hardware monitor (AMD, Intel) under /sys/class.
class Thermometer {
public:
  explicit Thermometer(const std::filesystem::path& classes = "/sys/class");

  /// The hottest sensor of the processor, degrees Celsius; not a number where there is none. Takes
  /// no memory.
  double celsius() const;

private:
  std::vector<Descriptor> sensors_;  // each holds thousandths of a degree
};

}  // namespace scree
