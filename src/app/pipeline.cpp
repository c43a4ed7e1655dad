#include "scree/app/pipeline.hpp"

#include <utility>

namespace scree {

Result<Detector> make_detector(const DetectSettings& settings,
                               const std::filesystem::path& config_folder) {
  const auto file = find_file(settings.network, config_folder);
  if (!file) return tl::make_unexpected(file.error());
  auto network = Network::load(*file);
  if (!network) return tl::make_unexpected(network.error());
  return Detector(settings, *std::move(network));
}

Result<Pipeline> Pipeline::make(const Settings& settings,
                                const std::filesystem::path& config_folder) {
  auto detector = make_detector(settings.detect_sweep, config_folder);
  if (!detector) return tl::make_unexpected(detector.error());
  return Pipeline(settings, *std::move(detector));
}

Pipeline::Pipeline(const Settings& settings, Detector detector)
    : lidar_(settings.lidar),
      ground_(static_cast<std::size_t>(settings.detect_sweep.max_points)),
      detector_(std::move(detector)),
      list_(static_cast<std::size_t>(settings.detect_sweep.max_obstacles)) {}

const ObstacleList& Pipeline::process(const Sweep& sweep) {
  move_to_base(sweep);
  list_.stamp_ns = sweep.end_ns;
  detector_.detect(ground_, list_.obstacles);
  return list_;
}

StageCounts Pipeline::counts() const {
  StageCounts counts = detector_.counts();
  counts.input += dropped_;
  counts.dropped += dropped_;
  return counts;
}

void Pipeline::move_to_base(const Sweep& sweep) {
  const Pose mount = lidar_.mount();
  const Eigen::Matrix3f rotation = mount.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f translation = mount.translation.cast<float>();
  const auto nearest = static_cast<float>(lidar_.min_range * lidar_.min_range);
  const auto farthest = static_cast<float>(lidar_.max_range * lidar_.max_range);
  ground_.clear();
  dropped_ = 0;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const Eigen::Vector3f seen(sweep.points.x[i], sweep.points.y[i], sweep.points.z[i]);
    const float square = seen.squaredNorm();
    if (square < nearest || square > farthest) continue;
    const Eigen::Vector3f point = rotation * seen + translation;
    if (!ground_.push_back(point.x(), point.y(), point.z(), sweep.points.reflectivity[i])) {
      ++dropped_;
    }
  }
}

}  // namespace scree
