#include "study/drive_results.hpp"

#include <algorithm>
#include <utility>

#include "commands.hpp"
#include "common/progress.hpp"
#include "scree/app/pipeline.hpp"
#include "simulator/drive.hpp"
#include "simulator/parallel.hpp"

namespace scree::cli {
namespace {

/// What came of one drive.
struct DriveResult {
  Truth truth;
  Truth after_faults;  ///< the same, of the times after the last gap of a sensor
  std::array<std::vector<ObstacleList>, kDriveWays> lists;
  SurfaceError surface, level;

  std::vector<ObstacleList>& of(DriveWay way) { return lists[static_cast<std::size_t>(way)]; }
};

Pipeline make_pipeline(const Settings& settings, const StudyTask& task) {
  return value_or_fail(Pipeline::make(settings, task.config_file));
}

ObstacleList copy_of(const ObstacleList& list) {
  ObstacleList copy(list.obstacles.size());
  copy.stamp_ns = list.stamp_ns;
  copy.pose = list.pose;
  for (const Obstacle& obstacle : list.obstacles) copy.obstacles.push_back(obstacle);
  return copy;
}

void drive_with_faults(const Drive& drive, const Settings& settings, const StudyTask& task,
                       DriveResult& result) {
  const Faults faults = draw_faults(drive.settings.seconds, drive.settings.seed);
  Pipeline pipeline = make_pipeline(settings, task);
  DriveFeed feed(drive, faults);
  Sweep sweep(static_cast<std::size_t>(settings.memory.sweep_points));
  while (feed.next(sweep, {&pipeline.sensors()})) {
    result.of(DriveWay::faults).push_back(copy_of(pipeline.process(sweep)));
  }
  const double seconds = std::max(faults.imu_gap.end(), faults.encoder_gap.end());
  const std::int64_t end_ns =
      result.truth.poses.front().t_ns + static_cast<std::int64_t>(seconds * 1e9);
  result.after_faults = result.truth;
  std::erase_if(result.after_faults.visible,
                [&](const Truth::Sight& sight) { return sight.t_ns < end_ns; });
}

void drive_without_faults(const Drive& drive, const Settings& settings, const StudyTask& task,
                          DriveResult& result) {
  Settings unregistered = settings;
  unregistered.map.registration = false;
  Pipeline pipeline = make_pipeline(settings, task);
  Pipeline dead_reckoning = make_pipeline(unregistered, task);
  Pipeline sweeps = make_pipeline(unregistered, task);
  DriveFeed feed(drive);
  Sweep sweep(static_cast<std::size_t>(settings.memory.sweep_points));
  while (feed.next(sweep, {&pipeline.sensors(), &dead_reckoning.sensors()})) {
    result.of(DriveWay::pipeline).push_back(copy_of(pipeline.process(sweep)));
    result.of(DriveWay::dead_reckoning).push_back(copy_of(dead_reckoning.process(sweep)));
    result.of(DriveWay::sweeps).push_back(copy_of(sweeps.process(sweep)));
    result.truth.poses.push_back({sweep.end_ns, drive.motion.base(sweep.end_ns)});
  }
  result.truth.obstacles = feed.truth().obstacles;
  result.truth.visible = feed.truth().visible;
  const Mapper& mapper = pipeline.mapper();
  const auto error_of_map = [&](Pose to_world) {
    to_world.translation = to_world * mapper.map().origin();  // the cloud is shifted by it
    return surface_error(drive.terrain, mapper.map().cloud(), to_world);
  };
  const Pose& truth = result.truth.poses.back().base;
  const Pose& to_odom = mapper.to_odom();
  result.surface = error_of_map(laid_onto(to_odom * mapper.pose(), truth) * to_odom);
  const Eigen::Quaterniond turn = truth.rotation * mapper.pose().rotation.conjugate();
  result.level = error_of_map({truth.translation - turn * mapper.pose().translation, turn});
}

DriveResult drive_once(const StudyTask& task, Scene scene, std::uint64_t seed) {
  CaptureSettings drawn;
  drawn.seed = seed;
  drawn.scene = scene;
  drawn.seconds = task.seconds;
  const Drive drive(drawn);
  const Settings settings = with_sensors_of(drive.robot, task.settings);
  DriveResult result;
  drive_without_faults(drive, settings, task, result);
  if (drawn.seconds >= kLeastFaultySeconds) {
    drive_with_faults(drive, settings, task, result);
  }
  return result;
}

/// The same truth that asks for no others.
Truth of_warned_obstacles(Truth truth) {
  const auto is_warned = [&](int id) {
    const auto& obstacle = *std::ranges::find(truth.obstacles, id, &TrueObstacle::id);
    return obstacle.kind == ObstacleKind::positive
               ? obstacle.height >= kWarnedHeight
               : least_width(obstacle.footprint) >= kWarnedWidth;
  };
  for (Truth::Sight& sight : truth.visible) {
    const auto others = std::stable_partition(sight.ids.begin(), sight.ids.end(), is_warned);
    sight.ignore.insert(sight.ignore.end(), others, sight.ids.end());
    sight.ids.erase(others, sight.ids.end());
  }
  return truth;
}

void add(SceneResult& scene, DriveResult& drive) {
  for (std::size_t way = 0; way < kDriveWays; ++way) {
    if (!drive.lists[way].empty()) scene.scorers[way].add(drive.truth, drive.lists[way]);
  }
  if (!drive.after_faults.visible.empty()) {
    scene.healed.add(drive.after_faults, drive.of(DriveWay::faults));
    scene.unharmed.add(drive.after_faults, drive.of(DriveWay::pipeline));
  }
  scene.large.add(of_warned_obstacles(drive.truth), drive.of(DriveWay::pipeline));
  scene.surface += drive.surface;
  scene.level += drive.level;
}

}  // namespace

std::vector<SceneResult> drive_all_scenes(const StudyTask& task) {
  std::vector<DriveResult> drives(kScenes.size() * task.seeds.count);
  const auto scene_of = [&](std::size_t i) { return i % kScenes.size(); };
  {
    Progress progress("drives", drives.size());
    const auto make_work = [&] {
      return [&](std::size_t i) {
        drives[i] = drive_once(task, kScenes[scene_of(i)], task.seeds.first + i);
      };
    };
    in_parallel(drives.size(), make_work, std::ref(progress));
  }
  std::vector<SceneResult> scenes(kScenes.size());
  for (std::size_t i = 0; i < drives.size(); ++i) {
    scenes[scene_of(i)].scene = kScenes[scene_of(i)];
    add(scenes[scene_of(i)], drives[i]);
  }
  return scenes;
}

}  // namespace scree::cli
