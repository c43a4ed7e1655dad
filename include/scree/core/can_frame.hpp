#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace scree {

inline constexpr std::uint32_t kLargestStandardId = 0x7FF;
inline constexpr std::uint32_t kLargestExtendedId = 0x1FFFFFFF;

/// A frame of the CAN bus, classic or FD, or the kernel's report of an error on the bus.
struct CanFrame {
  std::int64_t t_ns = 0;     ///< host time of its arrival
  std::uint32_t id = 0;      ///< without flags; of an error frame the classes of error
  bool is_extended = false;  ///< the identifier has 29 bits
  bool is_error = false;     ///< made by the kernel or the controller, was never on the bus
  bool is_remote = false;    ///< asks for data and has none; `size` says how much it asks for
  std::uint8_t size = 0;     ///< bytes of data: up to 8, FD up to 64
  std::array<std::uint8_t, 64> data{};

  std::span<const std::uint8_t> payload() const {
    return std::span(data).first(is_remote ? 0 : size);
  }
};

}  // namespace scree
