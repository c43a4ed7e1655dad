#include "simulator/lidar.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <numeric>

#include "scree/drivers/velodyne/lasers.hpp"

namespace scree {
namespace {

using namespace velodyne;

constexpr std::size_t kFiringsPerBlock = 2;
constexpr std::uint8_t kPpsLocked = 2;

template <class T>
void put(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
}

std::uint32_t past_the_hour_us(std::int64_t t_ns) {
  return static_cast<std::uint32_t>(t_ns % kHourNs / 1000);
}

/// GPRMC of a fixed place at this time.
std::string nmea_sentence(std::int64_t t_ns) {
  const auto seconds = static_cast<std::time_t>(t_ns / 1'000'000'000);
  const std::string body =
      fmt::format("GPRMC,{0:%H%M%S},A,4730.0000,N,00720.0000,E,000.0,000.0,{0:%d%m%y},000.0,E",
                  fmt::gmtime(seconds));
  const unsigned check = std::accumulate(body.begin(), body.end(), 0U, [](unsigned sum, char c) {
    return sum ^ static_cast<unsigned char>(c);
  });
  return fmt::format("${}*{:02X}\r\n", body, check);
}

}  // namespace

SimulatedLidar::SimulatedLidar(const Terrain& terrain, const RayCaster& caster,
                               const SimulatedLidarSettings& settings, const Pose& mount,
                               std::int64_t start_ns, std::uint64_t seed)
    : terrain_(terrain),
      caster_(caster),
      settings_(settings),
      mount_(mount),
      rotation_(mount.rotation.toRotationMatrix()),
      start_ns_(start_ns),
      packet_ns_(start_ns - packet_duration_ns(settings.mode)),
      random_(seed, 0x11DA),
      shot_count_(settings.mode == ReturnMode::dual ? kShots / 2 : kShots) {
  const Lasers& lasers = lasers_of(settings.model);
  for (std::size_t i = 0; i < kLasers; ++i) {
    const double elevation = radians(lasers[i].elevation_deg);
    beams_[i] = {std::cos(elevation), std::sin(elevation), lasers[i].correction_mm * 1e-3};
  }
}

void SimulatedLidar::advance() {
  packet_ns_ += packet_duration_ns(settings_.mode);
  for (std::size_t i = 0; i < shot_count_; ++i) {
    const auto firing = static_cast<std::int64_t>(i / kLasers);
    const auto laser = static_cast<std::int64_t>(i % kLasers);
    shots_[i] = cast(i % kLasers, packet_ns_ + firing * kFiringNs + laser * kShotNs);
  }
}

double SimulatedLidar::turns(std::int64_t t_ns) const {
  return settings_.rate_hz * 1e-9 * static_cast<double>(t_ns - start_ns_);
}

Eigen::Vector3d SimulatedLidar::direction(std::size_t laser, std::int64_t t_ns) const {
  const double turned = turns(t_ns);
  const double azimuth = 2 * std::numbers::pi * (turned - std::floor(turned));
  const Beam& beam = beams_[laser];
  return {beam.cos_elevation * std::cos(azimuth), -beam.cos_elevation * std::sin(azimuth),
          beam.sin_elevation};
}

Eigen::Vector3d SimulatedLidar::point_of(std::size_t shot) const {
  const std::size_t laser = shot % kLasers;
  return static_cast<double>(shots_[shot].range) * direction(laser, shots_[shot].t_ns) +
         Eigen::Vector3d(0, 0, beams_[laser].origin_z);
}

SimulatedShot SimulatedLidar::cast(std::size_t laser, std::int64_t t_ns) {
  SimulatedShot shot{.t_ns = t_ns};
  const Eigen::Vector3d origin = mount_ * Eigen::Vector3d(0, 0, beams_[laser].origin_z);
  const Eigen::Vector3d beam = rotation_ * direction(laser, t_ns);
  const auto range = caster_.cast(origin, beam, settings_.reach);
  if (!range) return shot;
  const Eigen::Vector3d hit = origin + *range * beam;
  const double material = terrain_.reflectivity(hit.x(), hit.y());
  const double facing = std::max(-beam.dot(terrain_.normal(hit.x(), hit.y())), 0.0);
  // Light that comes back, against the receiver's threshold: dark, far and grazing shots get lost.
  constexpr double kThreshold = 0.0015;
  const double light = (0.05 + material / 100) * facing * 100 / (*range * *range);
  if (random_.chance(settings_.lost_share) || random_.chance(std::exp(-light / kThreshold))) {
    return shot;
  }
  shot.range = static_cast<float>(std::max(*range + settings_.range_noise * random_.normal(), 0.0));
  shot.reflectivity = static_cast<std::uint8_t>(
      std::clamp(std::round(material * (0.6 + 0.4 * facing) + 2 * random_.normal()), 0.0, 255.0));
  // On the very brink of a hole, or on a rock's skirt, nothing is seen of it yet.
  constexpr double kTelling = 0.05;
  if (std::abs(terrain_.relief(hit.x(), hit.y())) > kTelling) {
    shot.feature = static_cast<std::uint8_t>(terrain_.feature_at(hit.x(), hit.y()));
  }
  return shot;
}

std::uint16_t SimulatedLidar::azimuth_counts(std::int64_t t_ns) const {
  const double turned = turns(t_ns);
  const double counts = std::round((turned - std::floor(turned)) * kFullTurn);
  return static_cast<std::uint16_t>(static_cast<int>(counts) % kFullTurn);
}

std::array<std::uint8_t, kDataPacketSize> SimulatedLidar::data_packet() const {
  std::array<std::uint8_t, kDataPacketSize> bytes{};
  const bool dual = settings_.mode == ReturnMode::dual;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    // With one return only, both blocks of a dual pair carry it.
    const std::size_t first = (dual ? block / 2 : block) * kFiringsPerBlock * kLasers;
    const std::size_t at = block * kBlockSize;
    put(bytes, at, kBlockFlag);
    put(bytes, at + kAzimuthOffset, azimuth_counts(shots_[first].t_ns));
    for (std::size_t i = 0; i < kShotsPerBlock; ++i) {
      const SimulatedShot& shot = shots_[first + i];
      const float counts = std::min(std::round(shot.range * kCountsPerMetre), 65535.0F);
      put(bytes, at + kReturnsOffset + i * kReturnSize, static_cast<std::uint16_t>(counts));
      bytes[at + kReturnsOffset + i * kReturnSize + 2] = shot.reflectivity;
    }
  }
  put(bytes, kTimestampOffset, past_the_hour_us(packet_ns_));
  put(bytes, kReturnModeOffset, settings_.mode);
  put(bytes, kProductOffset,
      settings_.model == LidarModel::puck_hires ? Product::puck_hires : Product::vlp16);
  return bytes;
}

std::array<std::uint8_t, kPositionPacketSize> SimulatedLidar::position_packet() const {
  std::array<std::uint8_t, kPositionPacketSize> bytes{};
  put(bytes, kPositionTimestampOffset, past_the_hour_us(packet_end_ns()));
  bytes[kPpsStatusOffset] = kPpsLocked;
  const std::string sentence = nmea_sentence(packet_end_ns());
  std::copy(sentence.begin(), sentence.end(), bytes.begin() + kNmeaOffset);
  return bytes;
}

}  // namespace scree
