#include "scree/terrain/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {
namespace {

constexpr int kMaxRounds = 5;
constexpr double kConverged = 2e-4;  // metres plus radians
constexpr std::size_t kMaxKeyPoints = 1500;
constexpr std::size_t kMinKeyPoints = 50;
constexpr double kRangeNoise = 0.02;  // metres; the VLP-16's data sheet has 0.03 at most
/// Points share the errors of the surfels, from sweep to sweep too, and of the motion within a
/// sweep: they bind the pose only as firmly as so many times fewer. With less, one boulder on flat
/// ground draws the yaw off by a degree in 12 s of a simulated drive.
constexpr double kShared = 40;
/// The same while the IMU is silent: nothing else then says how the robot is tilted.
constexpr double kSharedAlone = 15;

constexpr std::size_t kTilts = 3, kHeadings = 8, kBins = 1 + kTilts * kHeadings;

/// The bin of a surfel's normal: one of level ground, the others by steepness and direction.
std::size_t bin_of(const Eigen::Vector3f& normal) {
  const float tilt = std::acos(std::clamp(normal.z(), -1.0F, 1.0F));
  constexpr float kLevel = 0.1F, kStep = 0.3F;
  if (tilt < kLevel) return 0;
  const auto steep = std::min(static_cast<std::size_t>((tilt - kLevel) / kStep), kTilts - 1);
  const float heading = std::atan2(normal.y(), normal.x()) / static_cast<float>(2 * M_PI) + 0.5F;
  const auto direction = std::min(static_cast<std::size_t>(heading * kHeadings), kHeadings - 1);
  return 1 + steep * kHeadings + direction;
}

Eigen::Vector3f transformed(const Pose& pose, const Eigen::Vector3f& point) {
  return (pose * point.cast<double>()).cast<float>();
}

/// Standard deviation of points 3 m off, metres.
template <class Filter>
double uncertainty_of(const Filter& filter) {
  const Eigen::Matrix<double, 6, 1> variances = filter.covariance().diagonal().template head<6>();
  return std::sqrt(variances.head<3>().maxCoeff() + 9 * variances.segment<3>(3).maxCoeff());
}

}  // namespace

Registration::Registration(std::size_t max_points)
    : key_points_(kMaxKeyPoints), bins_(max_points) {}

void Registration::choose_key_points(const DeskewedSweep& sweep, SurfelMap& map, const Pose& pose) {
  constexpr std::uint8_t kNone = kBins;
  std::array<std::size_t, kBins> sizes{};
  bins_.resize(sweep.points.size());
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f point(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const Surfel* surfel = sweep.is_suspect[i] != 0 ? nullptr : map.at(transformed(pose, point));
    bins_[i] = surfel == nullptr ? kNone : static_cast<std::uint8_t>(bin_of(surfel->normal));
    if (surfel != nullptr) ++sizes[bins_[i]];
  }
  // As many from each direction as there is room for: the smallest bins give all they have.
  std::array<std::size_t, kBins> order{}, wanted{};
  for (std::size_t bin = 0; bin < kBins; ++bin) order[bin] = bin;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return sizes[a] != sizes[b] ? sizes[a] < sizes[b] : a < b;
  });
  std::size_t room = kMaxKeyPoints, left = kBins;
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
    key_points_.push_back({{sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]},
                           -1e-9F * static_cast<float>(sweep.time_ns[i])});
  }
}

/// The key points' distances from the surfels at a pose, as evidence about it. A correspondence
/// counts by a Cauchy weight of its distance, and within three standard deviations.
/// @param uncertainty standard deviation of the points by the pose's error, metres
template <class Filter>
Registration::Linearization<typename Filter::Evidence> Registration::linearize(
    const Filter& filter, double uncertainty, double shared, SurfelMap& map) const {
  Linearization<typename Filter::Evidence> sum;
  for (const KeyPoint& key_point : key_points_) {
    const Eigen::Vector3d in_base = key_point.place.cast<double>();
    const double before_s = key_point.before_s;
    const Eigen::Vector3d point = filter.place(in_base, before_s);
    const Surfel* const surfel = map.at(point.cast<float>());
    if (surfel == nullptr) continue;
    const Eigen::Vector3d normal = surfel->normal.cast<double>();
    const double distance = normal.dot(point - surfel->center.cast<double>());
    const double variance =
        kRangeNoise * kRangeNoise + static_cast<double>(surfel->thickness) * surfel->thickness;
    const double expected = variance + uncertainty * uncertainty;
    if (std::abs(distance) > 3 * std::sqrt(expected)) continue;
    const double robust = 1 / (1 + distance * distance / expected);
    const double weight = robust / (variance * shared);
    const auto jacobian = filter.jacobian(in_base, before_s, normal);
    sum.evidence.information += weight * jacobian * jacobian.transpose();
    sum.evidence.gradient += weight * distance * jacobian;
    sum.squares += robust * distance * distance;
    sum.weights += robust;
    ++sum.count;
  }
  return sum;
}

template <class Filter>
Registration::Outcome Registration::align(const DeskewedSweep& sweep, SurfelMap& map,
                                          Filter& filter) {
  constexpr double kUncertaintyAfter = 0.02;  // metres: the first round has found the pose roughly
  Outcome outcome;
  choose_key_points(sweep, map, filter.pose());
  if (key_points_.size() < kMinKeyPoints) return outcome;
  const Eigen::Vector3d predicted = filter.pose().translation;
  const double shared = filter.knows_attitude() ? kShared : kSharedAlone;
  filter.begin_update();
  const double uncertainty = uncertainty_of(filter);
  typename Filter::Evidence evidence;
  for (int round = 1; round <= kMaxRounds; ++round) {
    const auto found = linearize(filter, round > 1 ? kUncertaintyAfter : uncertainty, shared, map);
    if (found.count < static_cast<int>(kMinKeyPoints)) break;
    evidence = found.evidence;
    outcome.key_points = found.count;
    outcome.rounds = round;
    outcome.residual = std::sqrt(found.squares / found.weights);
    if (filter.update(evidence) < kConverged) break;
  }
  if (outcome.rounds == 0) return outcome;
  filter.end_update(evidence);
  outcome.correction = (filter.pose().translation - predicted).norm();
  return outcome;
}

template Registration::Outcome Registration::align(const DeskewedSweep&, SurfelMap&, PoseFilter&);
template Registration::Outcome Registration::align(const DeskewedSweep&, SurfelMap&, TwistFilter&);

}  // namespace scree
