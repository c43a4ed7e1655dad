#include "simulator/lidar.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <numbers>
#include <numeric>

#include "scree/core/sweep.hpp"
#include "scree/drivers/velodyne/lasers.hpp"

namespace scree {
namespace {

using namespace velodyne;

constexpr std::size_t kFiringsPerBlock = 2;
constexpr std::uint8_t kPpsLocked = 2;

const Motion& at_rest() {
  static const Motion motion{Pose()};
  return motion;
}

template <class T>
void put(std::span<std::uint8_t> bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof value);
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
                               const SimulatedLidarSettings& settings, const Motion& motion,
                               const Pose& mount, std::int64_t start_ns, std::uint64_t seed,
                               std::span<const Mover> movers)
    : settings_(settings),
      motion_(motion),
      mount_(mount),
      start_ns_(start_ns),
      packet_ns_(start_ns - packet_duration_ns(settings.mode)),
      random_(seed, 0x11DA),
      beam_(terrain, caster, settings.reach),
      movers_(movers, terrain, terrain.parts().size()),
      dust_(settings.dust_puffs, motion, start_ns, seed),
      echoes_(Beam::kMostEchoes + 2),
      shot_count_(settings.mode == ReturnMode::dual ? kShots / 2 : kShots) {
  if (!movers.empty()) beam_.add(movers_);
  const Lasers& lasers = lasers_of(settings.model);
  for (std::size_t i = 0; i < kLasers; ++i) {
    const double elevation = radians(lasers[i].elevation_deg);
    lasers_[i] = {std::cos(elevation), std::sin(elevation), lasers[i].correction_mm * 1e-3,
                  settings.laser_bias * random_.normal()};
  }
}

SimulatedLidar::SimulatedLidar(const Terrain& terrain, const RayCaster& caster,
                               const SimulatedLidarSettings& settings, const Pose& mount,
                               std::int64_t start_ns, std::uint64_t seed)
    : SimulatedLidar(terrain, caster, settings, at_rest(), mount, start_ns, seed) {}

void SimulatedLidar::advance() {
  packet_ns_ += packet_duration_ns(settings_.mode);
  dust_.advance(packet_ns_);
  movers_.move_to(packet_ns_);
  for (std::size_t i = 0; i < shot_count_; ++i) {
    const auto firing = static_cast<std::int64_t>(i / kLasers);
    const auto laser = static_cast<std::int64_t>(i % kLasers);
    shots_[i] = cast(i % kLasers, packet_ns_ + firing * kFiringNs + laser * kShotNs);
  }
}

double SimulatedLidar::turns(std::int64_t t_ns) const {
  return settings_.start_turn + settings_.rate_hz * 1e-9 * static_cast<double>(t_ns - start_ns_);
}

Eigen::Matrix3d SimulatedLidar::axes(std::size_t laser, std::int64_t t_ns) const {
  const double turned = turns(t_ns);
  const double azimuth = 2 * std::numbers::pi * (turned - std::floor(turned));
  const double c = std::cos(azimuth);
  const double s = std::sin(azimuth);
  const double ce = lasers_[laser].cos_elevation;
  const double se = lasers_[laser].sin_elevation;
  Eigen::Matrix3d axes;
  axes << ce * c, s, -se * c, -ce * s, c, se * s, se, 0, ce;
  return axes;
}

Eigen::Vector3d SimulatedLidar::point_of(std::size_t shot) const {
  const std::size_t laser = shot % kLasers;
  const float range = shots_[shot].range > 0 ? shots_[shot].range : kNoReturnRange;
  return static_cast<double>(range) * axes(laser, shots_[shot].t_ns).col(0) +
         Eigen::Vector3d(0, 0, lasers_[laser].origin_z);
}

SimulatedShot SimulatedLidar::cast(std::size_t laser, std::int64_t t_ns) {
  SimulatedShot shot{.t_ns = t_ns};
  const Pose base = motion_.base(t_ns);
  const Eigen::Vector3d origin = base * (mount_ * Eigen::Vector3d(0, 0, lasers_[laser].origin_z));
  const Eigen::Matrix3d beam =
      (base.rotation * mount_.rotation).toRotationMatrix() * axes(laser, t_ns);
  echoes_.clear();
  for (const Echo& echo : beam_.cast(origin, beam.col(0), beam.col(1), beam.col(2), random_)) {
    // Dark, far and grazing surfaces get lost.
    if (random_.chance(std::exp(-echo.light)) || random_.chance(settings_.lost_share)) continue;
    echoes_.push_back(echo);
  }
  if (random_.chance(settings_.dust_share)) add_dust(random_.uniform(0.6, 5));
  if (const auto range = dust_.cast(origin, beam.col(0), t_ns, settings_.reach)) add_dust(*range);
  if (echoes_.empty()) return shot;
  const auto dimmer = [](const Echo& a, const Echo& b) { return a.light < b.light; };
  const Echo* strongest = std::max_element(echoes_.begin(), echoes_.end(), dimmer);
  const Echo* last = &echoes_[echoes_.size() - 1];
  shot.part = strongest->part;
  shot.relief = strongest->relief;
  shot.last_range = measured(*last, laser);
  shot.last_reflectivity = measured_reflectivity(*last);
  if (settings_.mode == ReturnMode::last || echoes_.size() == 1) {
    shot.range = shot.last_range;
    shot.reflectivity = shot.last_reflectivity;
    shot.part = last->part;
    shot.relief = last->relief;
    return shot;
  }
  if (settings_.mode == ReturnMode::dual && strongest == last) {
    strongest = std::max_element(echoes_.begin(), echoes_.end() - 1, dimmer);
  }
  shot.range = measured(*strongest, laser);
  shot.reflectivity = measured_reflectivity(*strongest);
  return shot;
}

void SimulatedLidar::add_dust(double range) {
  const Echo grain{
      .range = range, .light = 40 * random_.uniform(), .reflectivity = random_.uniform(1, 8)};
  if (!echoes_.empty() && echoes_[0].range < grain.range) return;
  echoes_.push_back(grain);
  std::rotate(echoes_.begin(), echoes_.end() - 1, echoes_.end());
}

float SimulatedLidar::measured(const Echo& echo, std::size_t laser) {
  // Faint echoes are timed less well.
  const double noise = settings_.range_noise * (1 + 2 * std::exp(-echo.light / 4));
  const double range = echo.range + lasers_[laser].bias + noise * random_.normal();
  return static_cast<float>(std::max(range, 0.0));
}

std::uint8_t SimulatedLidar::measured_reflectivity(const Echo& echo) {
  const double value = std::round(echo.reflectivity + 2 * random_.normal());
  return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
}

std::uint32_t SimulatedLidar::past_the_hour_us(std::int64_t t_ns) const {
  const auto since = static_cast<double>(t_ns - start_ns_);
  const auto gained = static_cast<std::int64_t>(settings_.clock_skew * since);
  return static_cast<std::uint32_t>((t_ns + settings_.clock_offset_ns + gained) % kHourNs / 1000);
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
    const std::size_t first = (dual ? block / 2 : block) * kFiringsPerBlock * kLasers;
    const std::size_t at = block * kBlockSize;
    put(bytes, at, kBlockFlag);
    put(bytes, at + kAzimuthOffset, azimuth_counts(shots_[first].t_ns));
    for (std::size_t i = 0; i < kShotsPerBlock; ++i) {
      const SimulatedShot& shot = shots_[first + i];
      const bool last = dual && block % 2 == 0;  // the even block of a pair (section 9.3.1)
      const float range = last ? shot.last_range : shot.range;
      const float counts = std::min(std::round(range * kCountsPerMetre), 65535.0F);
      put(bytes, at + kReturnsOffset + i * kReturnSize, static_cast<std::uint16_t>(counts));
      bytes[at + kReturnsOffset + i * kReturnSize + 2] =
          last ? shot.last_reflectivity : shot.reflectivity;
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
  if (!settings_.is_locked) return bytes;  // no GPS receiver: neither pulse nor sentence
  bytes[kPpsStatusOffset] = kPpsLocked;
  const std::string sentence = nmea_sentence(packet_end_ns());
  std::copy(sentence.begin(), sentence.end(), bytes.begin() + kNmeaOffset);
  return bytes;
}

}  // namespace scree
