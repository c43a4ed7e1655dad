#include "scree/terrain/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {
namespace {

constexpr int kRounds = 5;
constexpr double kConverged = 2e-4;  // metres plus radians
constexpr std::size_t kKeyPoints = 1500;
constexpr std::size_t kLeastKeyPoints = 50;
constexpr double kRangeNoise = 0.02;  // metres
/// Points share the errors of the surfels, from sweep to sweep too, and of the motion within a
/// sweep: they bind the pose only as firmly as this many fewer ...
constexpr double kShared = 40;
constexpr double kSharedAlone = 15;  // ... while the IMU is silent: nothing else says how it leans

constexpr std::size_t kTilts = 3, kHeadings = 8, kBins = 1 + kTilts * kHeadings;

/// Level, or by steepness and direction.
std::size_t bin_of(const Eigen::Vector3f& normal) {
  const float tilt = std::acos(std::clamp(normal.z(), -1.0F, 1.0F));
  constexpr float kLevel = 0.1F, kStep = 0.3F;
  if (tilt < kLevel) return 0;
  const auto steep = std::min(static_cast<std::size_t>((tilt - kLevel) / kStep), kTilts - 1);
  const float heading = std::atan2(normal.y(), normal.x()) / static_cast<float>(2 * M_PI) + 0.5F;
  const auto direction = std::min(static_cast<std::size_t>(heading * kHeadings), kHeadings - 1);
  return 1 + steep * kHeadings + direction;
}

Eigen::Vector3f moved(const Pose& pose, const Eigen::Vector3f& point) {
  return (pose * point.cast<double>()).cast<float>();
}

}  // namespace

Registration::Registration(std::size_t max_points) : key_points_(kKeyPoints), bins_(max_points) {}

void Registration::choose_key_points(const DeskewedSweep& sweep, SurfelMap& map, const Pose& pose) {
  constexpr std::uint8_t kNone = kBins;
  std::array<std::size_t, kBins> sizes{};
  bins_.resize(sweep.points.size());
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f point(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const Surfel* surfel = map.at(moved(pose, point));
    bins_[i] = surfel == nullptr ? kNone : static_cast<std::uint8_t>(bin_of(surfel->normal));
    if (surfel != nullptr) ++sizes[bins_[i]];
  }
  // As many from each direction as there is room for: the smallest bins give all they have.
  std::array<std::size_t, kBins> order{}, wanted{};
  for (std::size_t bin = 0; bin < kBins; ++bin) order[bin] = bin;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a] != sizes[b] ? sizes[a] < sizes[b] : a < b;
  });
  std::size_t room = kKeyPoints, left = kBins;
  for (const std::size_t bin : order) {
    wanted[bin] = std::min(sizes[bin], room / left);
    room -= wanted[bin];
    --left;
  }
  key_points_.clear();
  std::array<std::size_t, kBins> due{};
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const std::uint8_t bin = bins_[i];
    if (bin == kNone) continue;
    due[bin] += wanted[bin];
    if (due[bin] < sizes[bin]) continue;
    due[bin] -= sizes[bin];
    key_points_.push_back({sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]});
  }
}

Registration::Outcome Registration::align(const DeskewedSweep& sweep, SurfelMap& map,
                                          PoseFilter& filter) {
  Outcome outcome;
  choose_key_points(sweep, map, filter.pose());
  if (key_points_.size() < kLeastKeyPoints) return outcome;
  const Eigen::Vector3d predicted = filter.pose().translation;
  const double shared = filter.knows_attitude() ? kShared : kSharedAlone;
  filter.begin_update();
  PoseEvidence evidence;
  for (int round = 1; round <= kRounds; ++round) {
    const Pose pose = filter.pose();
    const double uncertain =
        round > 1 ? 0.02
                  : std::sqrt(filter.covariance().diagonal().head<3>().maxCoeff() +
                              9 * filter.covariance().diagonal().segment<3>(3).maxCoeff());
    PoseEvidence seen;
    double squares = 0, weights = 0;
    int counted = 0;
    for (const Eigen::Vector3f& key_point : key_points_) {
      const Eigen::Vector3d turned = pose.rotation * key_point.cast<double>();
      const Eigen::Vector3d point = turned + pose.translation;
      const Surfel* surfel = map.at(point.cast<float>());
      if (surfel == nullptr) continue;
      const Eigen::Vector3d normal = surfel->normal.cast<double>();
      const double distance = normal.dot(point - surfel->center.cast<double>());
      const double variance =
          kRangeNoise * kRangeNoise + static_cast<double>(surfel->thickness) * surfel->thickness;
      const double threshold = 3 * std::sqrt(variance + uncertain * uncertain);
      if (std::abs(distance) > threshold) continue;
      const double ratio = distance * distance / (variance + uncertain * uncertain);
      const double robust = 1 / (1 + ratio);
      const double weight = robust / (variance * shared);
      Eigen::Matrix<double, 6, 1> jacobian;
      jacobian << normal, turned.cross(normal);
      seen.information += weight * jacobian * jacobian.transpose();
      seen.gradient += weight * distance * jacobian;
      squares += robust * distance * distance;
      weights += robust;
      ++counted;
    }
    if (counted < static_cast<int>(kLeastKeyPoints)) break;
    evidence = seen;
    outcome.key_points = counted;
    outcome.rounds = round;
    outcome.residual = std::sqrt(squares / weights);
    if (filter.update(evidence) < kConverged) break;
  }
  if (outcome.rounds == 0) return outcome;
  filter.end_update(evidence);
  outcome.correction = (filter.pose().translation - predicted).norm();
  return outcome;
}

}  // namespace scree
