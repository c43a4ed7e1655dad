#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

// The packets of the Velodyne VLP-16, Puck LITE and Puck Hi-Res, as the VLP-16 User Manual 63-9243
// Rev. D describes them (chapter 9). All numbers are little-endian, lengths are in bytes.
namespace scree::velodyne {

static_assert(std::endian::native == std::endian::little, "the wire is read as it lies in memory");

using Bytes = std::span<const std::uint8_t>;

// A data packet: 12 blocks, then the time stamp and two factory bytes (section 9.3.1).
inline constexpr std::size_t kDataPacketSize = 1206;
inline constexpr std::size_t kBlocks = 12;
inline constexpr std::size_t kBlockSize = 100;
inline constexpr std::size_t kTimestampOffset = kBlocks * kBlockSize;
inline constexpr std::size_t kReturnModeOffset = kTimestampOffset + 4;
inline constexpr std::size_t kProductOffset = kTimestampOffset + 5;

// A block: flag, azimuth, and 32 returns of three bytes: two firings of all 16 lasers.
inline constexpr std::uint16_t kBlockFlag = 0xEEFF;  // FF EE on the wire
inline constexpr std::size_t kAzimuthOffset = 2;
inline constexpr std::size_t kReturnsOffset = 4;
inline constexpr std::size_t kReturnSize = 3;
inline constexpr std::size_t kLasers = 16;
inline constexpr std::size_t kShotsPerBlock = 2 * kLasers;
inline constexpr std::size_t kShots = kBlocks * kShotsPerBlock;

inline constexpr float kCountsPerMetre = 500.0F;  // a distance counts 2 mm
inline constexpr int kFullTurn = 36000;           // an azimuth counts 0.01 deg

// Timing of the lasers (section 9.5); with dual returns two blocks share their two firings.
inline constexpr std::int32_t kShotNs = 2304;
inline constexpr std::int32_t kFiringNs = 55296;
inline constexpr std::int32_t kBlockNs = 2 * kFiringNs;
inline constexpr std::int32_t kPacketNs = static_cast<std::int32_t>(kBlocks) * kBlockNs;

inline constexpr std::uint32_t kHourUs = 3'600'000'000;  // time stamps begin anew there
inline constexpr std::int64_t kHourNs = 3'600'000'000'000;

enum class ReturnMode : std::uint8_t { strongest = 0x37, last = 0x38, dual = 0x39 };

enum class Product : std::uint8_t {
  hdl32e = 0x21,  ///< early firmware of the VLP-16 writes it too
  vlp16 = 0x22,   ///< and Puck LITE
  puck_hires = 0x24,
  vlp32 = 0x23,
  vlp32c = 0x28,
  velarray = 0x31,
  vls128 = 0xA1
};

// A position packet (section 9.3.2).
inline constexpr std::size_t kPositionPacketSize = 512;
inline constexpr std::size_t kPositionTimestampOffset = 198;
inline constexpr std::size_t kPpsStatusOffset = 202;
inline constexpr std::size_t kNmeaOffset = 206;

/// Reads a number from the wire. @pre offset + sizeof(T) <= bytes.size()
template <class T>
T read(Bytes bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// How long one packet's firings take.
constexpr std::int32_t packet_duration_ns(ReturnMode mode) {
  return mode == ReturnMode::dual ? kPacketNs / 2 : kPacketNs;
}

}  // namespace scree::velodyne
