#include "scree/drivers/velodyne/data_packet.hpp"

#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/lasers.hpp"
#include "trigonometry.hpp"

namespace scree::velodyne {
namespace {

constexpr AzimuthTable kAzimuths;

/// The motor turns at 300 to 1200 rpm (63-9243 Rev. D), at most 0.8 degrees a block. Twice that is
/// no rotation.
constexpr int kMaxStep = 160;

constexpr bool is_dual(ReturnMode mode) {
  return mode == ReturnMode::dual;
}

constexpr PerShot<std::int32_t> shot_times(bool dual) {
  PerShot<std::int32_t> times{};
  for (std::size_t shot = 0; shot < kShots; ++shot) {
    const std::size_t block = dual ? block_of(shot) / 2 : block_of(shot);
    const std::size_t firing = 2 * block + shot % kShotsPerBlock / kLasers;
    times[shot] = static_cast<std::int32_t>(firing) * kFiringNs +
                  static_cast<std::int32_t>(laser_of(shot)) * kShotNs;
  }
  return times;
}
constexpr PerShot<std::int32_t> kSingleTimes = shot_times(false);
constexpr PerShot<std::int32_t> kDualTimes = shot_times(true);

constexpr PerShot<std::uint16_t> shot_order(bool dual) {
  PerShot<std::uint16_t> order{};
  for (std::size_t i = 0; i < kShots; ++i) {
    const std::size_t pair = i / (2 * kShotsPerBlock), within = i % (2 * kShotsPerBlock);
    const std::size_t interleaved = (2 * pair + within % 2) * kShotsPerBlock + within / 2;
    order[i] = static_cast<std::uint16_t>(dual ? interleaved : i);
  }
  return order;
}
constexpr PerShot<std::uint16_t> kSingleOrder = shot_order(false);
constexpr PerShot<std::uint16_t> kDualOrder = shot_order(true);

/// Share of a block's step that the sensor has turned at each of its shots.
constexpr std::array<float, kShotsPerBlock> kShareOfStep = [] {
  std::array<float, kShotsPerBlock> shares{};
  for (std::size_t shot = 0; shot < kShotsPerBlock; ++shot) {
    shares[shot] = static_cast<float>(kSingleTimes[shot]) / static_cast<float>(kBlockNs);
  }
  return shares;
}();

/// A sensor whose clock is set by a GPS receiver may count on for some packets past the full hour
/// before it begins anew.
bool is_timestamp(std::uint32_t microseconds) {
  constexpr std::uint32_t kMostPast = 1'000'000;
  return microseconds < kHourUs + kMostPast;
}

unsigned azimuth_of(Bytes packet, std::size_t block) {
  const unsigned azimuth = read<std::uint16_t>(packet, block * kBlockSize + kAzimuthOffset);
  return azimuth == kFullTurn ? 0 : azimuth;
}

/// From each block's azimuth to the next block's, in hundredths of a degree.
struct AzimuthSteps {
  std::array<int, kBlocks> step{};
  int skipped = 0;
  int resumed_at = -1;  ///< azimuth behind the last jump

  /// Blocks that share their firings are `stride` apart.
  AzimuthSteps(const std::array<unsigned, kBlocks>& azimuth, std::size_t stride) {
    constexpr int kNone = -1;
    int before = kNone;
    for (std::size_t block = 0; block < kBlocks; block += stride) {
      int next = kNone;
      if (block + stride < kBlocks) {
        const int from = static_cast<int>(azimuth[block]);
        const int to = static_cast<int>(azimuth[block + stride]);
        next = (to - from + kFullTurn) % kFullTurn;
        if (next > kMaxStep) {
          skipped += next;
          resumed_at = to;
          next = kNone;
        }
      }
      before = step[block] = next == kNone ? before : next;
    }
    // What came before the first known step turned as fast.
    int after = 0;
    for (std::size_t block = kBlocks; block >= stride; block -= stride) {
      int& here = step[block - stride];
      after = here = here == kNone ? after : here;
      if (stride == 2) step[block - 1] = here;
    }
  }
};

}  // namespace

Refusal check_data_packet(Bytes datagram, LidarModel model) {
  if (datagram.size() != kDataPacketSize) return Refusal::size;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    if (read<std::uint16_t>(datagram, block * kBlockSize) != kBlockFlag) return Refusal::flags;
  }
  const bool hires = model == LidarModel::puck_hires;
  switch (product(datagram)) {
    case Product::puck_hires:
      if (!hires) return Refusal::puck_hires;
      break;
    case Product::vlp16:
    case Product::hdl32e:
      if (hires) return Refusal::vlp16;
      break;
    case Product::vlp32:
    case Product::vlp32c:
    case Product::velarray:
    case Product::vls128:
      return Refusal::unsupported;
    default:
      return Refusal::product;
  }
  switch (return_mode(datagram)) {
    case ReturnMode::strongest:
    case ReturnMode::last:
    case ReturnMode::dual:
      break;
    default:
      return Refusal::return_mode;
  }
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const auto azimuth = read<std::uint16_t>(datagram, block * kBlockSize + kAzimuthOffset);
    if (azimuth > kFullTurn) return Refusal::azimuth;
  }
  if (!is_timestamp(read<std::uint32_t>(datagram, kTimestampOffset))) return Refusal::timestamp;
  return Refusal::none;
}

Shots::Shots()
    : x{},
      y{},
      z{},
      range{},
      reflectivity{},
      azimuth{},
      time_ns(kSingleTimes),
      firing_order(kSingleOrder) {}

PacketDecoder::PacketDecoder(LidarModel model) {
  const Lasers& lasers = lasers_of(model);
  for (std::size_t shot = 0; shot < kShotsPerBlock; ++shot) {
    const Laser& laser = lasers[laser_of(shot)];
    const CosSin elevation = cos_sin_degrees(laser.elevation_deg);
    cos_elevation_[shot] = static_cast<float>(elevation.cos);
    sin_elevation_[shot] = static_cast<float>(elevation.sin);
    correction_[shot] = static_cast<float>(laser.correction_mm / 1000.0);
  }
}

void PacketDecoder::decode(Bytes packet, Shots& shots) const {
  shots.mode = return_mode(packet);
  const bool dual = is_dual(shots.mode);
  shots.time_ns = dual ? kDualTimes : kSingleTimes;
  shots.firing_order = dual ? kDualOrder : kSingleOrder;

  std::array<unsigned, kBlocks> azimuth{};
  for (std::size_t block = 0; block < kBlocks; ++block) {
    azimuth[block] = azimuth_of(packet, dual ? block & ~std::size_t{1} : block);
  }
  const AzimuthSteps steps(azimuth, dual ? 2 : 1);
  shots.skipped_deg = static_cast<float>(steps.skipped) / 100.0F;
  shots.resumed_at = static_cast<float>(steps.resumed_at);
  shots.degrees_per_block = static_cast<float>(steps.step[0]) / 100.0F;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    decode_block(packet.data() + block * kBlockSize, azimuth[block],
                 static_cast<float>(steps.step[block]), block * kShotsPerBlock, shots);
  }
}

void PacketDecoder::decode_block(const std::uint8_t* block, unsigned azimuth, float step,
                                 std::size_t first, Shots& shots) const {
  // Distance and reflectivity of a return in one 32-bit word; the byte read too many still lies in
  // the packet, whose blocks are followed by the time stamp.
  alignas(16) std::array<std::int32_t, kShotsPerBlock> words;
  for (std::size_t i = 0; i < kShotsPerBlock; ++i) {
    std::memcpy(&words[i], block + kReturnsOffset + kReturnSize * i, sizeof words[i]);
  }
  const CosSin start = kAzimuths[azimuth];
  const float cos_start = static_cast<float>(start.cos), sin_start = static_cast<float>(start.sin);
  const float azimuth_start = static_cast<float>(azimuth);
  const float step_rad = step * static_cast<float>(radians(0.01));

  // Written straight to the arrays of one struct: the compiler sees that they do not overlap.
  for (std::size_t i = 0; i < kShotsPerBlock; ++i) {
    const float range = static_cast<float>(words[i] & 0xFFFF) / kCountsPerMetre;
    shots.range[first + i] = range;
    shots.reflectivity[first + i] = static_cast<float>((words[i] >> 16) & 0xFF);

    const float turned = azimuth_start + step * kShareOfStep[i];
    // The wrap without a branch, so that the compiler can vectorise the loop.
    const int full_turn = ((kFullTurn - 1 - static_cast<int>(turned)) >> 31) & kFullTurn;
    shots.azimuth[first + i] = turned - static_cast<float>(full_turn);

    // The block's azimuth turned on by at most 1.6 degrees, where these two terms are exact to
    // 1e-8.
    const float angle = step_rad * kShareOfStep[i], square = angle * angle;
    const float cos_angle = 1.0F - 0.5F * square;
    const float sin_angle = angle - angle * square * (1.0F / 6.0F);
    const float cos_azimuth = cos_start * cos_angle - sin_start * sin_angle;
    const float sin_azimuth = sin_start * cos_angle + cos_start * sin_angle;

    const float way = range == 0.0F ? kNoReturnRange : range;
    const float horizontal = way * cos_elevation_[i];
    shots.x[first + i] = horizontal * cos_azimuth;
    shots.y[first + i] = -(horizontal * sin_azimuth);  // azimuth grows clockwise
    shots.z[first + i] = way * sin_elevation_[i] + correction_[i];
  }
}

}  // namespace scree::velodyne
