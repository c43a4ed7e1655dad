#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "scree/drivers/velodyne/wire.hpp"

namespace scree::velodyne {

/// A data packet to test with: without returns, all azimuths 0, until told otherwise.
class PacketBuilder {
public:
  PacketBuilder() {
    for (std::size_t block = 0; block < kBlocks; ++block) {
      put(block * kBlockSize, kBlockFlag);
    }
    mode(ReturnMode::strongest).product(Product::vlp16);
  }

  PacketBuilder& mode(ReturnMode mode) {
    bytes_[kReturnModeOffset] = static_cast<std::uint8_t>(mode);
    return *this;
  }
  PacketBuilder& product(Product product) {
    bytes_[kProductOffset] = static_cast<std::uint8_t>(product);
    return *this;
  }
  PacketBuilder& timestamp(std::uint32_t microseconds) {
    put(kTimestampOffset, microseconds);
    return *this;
  }
  PacketBuilder& azimuth(std::size_t block, int hundredths) {
    put(block * kBlockSize + kAzimuthOffset, static_cast<std::uint16_t>(hundredths));
    return *this;
  }
  /// A steady turn; call after mode(): with dual returns two blocks share an azimuth.
  PacketBuilder& turn(int first, int step) {
    const bool dual = bytes_[kReturnModeOffset] == static_cast<std::uint8_t>(ReturnMode::dual);
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const int steps = static_cast<int>(dual ? block / 2 : block);
      azimuth(block, (first + steps * step) % kFullTurn);
    }
    return *this;
  }
  PacketBuilder& shot(std::size_t shot, std::uint16_t counts, std::uint8_t reflectivity) {
    const std::size_t offset =
        shot / kShotsPerBlock * kBlockSize + kReturnsOffset + shot % kShotsPerBlock * kReturnSize;
    put(offset, counts);
    bytes_[offset + 2] = reflectivity;
    return *this;
  }
  PacketBuilder& all_shots(std::uint16_t counts, std::uint8_t reflectivity) {
    for (std::size_t i = 0; i < kShots; ++i) shot(i, counts, reflectivity);
    return *this;
  }

  std::array<std::uint8_t, kDataPacketSize>& bytes() { return bytes_; }
  const std::array<std::uint8_t, kDataPacketSize>& bytes() const { return bytes_; }

private:
  template <class T>
  void put(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }

  std::array<std::uint8_t, kDataPacketSize> bytes_{};
};

}  // namespace scree::velodyne
