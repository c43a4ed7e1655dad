#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <map>

#include "detection/pipeline_capture.hpp"
#include "report/gather.hpp"
#include "scree/motion/setup_report.hpp"

namespace scree::cli {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;

/// What the sensors said, second by second.
class RateLog {
public:
  RateLog(const PipelineCapture& capture, ReportData& data) : capture_(capture), data_(data) {}

  void see(std::int64_t now_ns) {
    if (last_ns_ != 0 && now_ns < last_ns_ + kSecondNs) return;
    const velodyne::LidarCounters& lidar = capture_.lidar().counters();
    const MotionCapture& motion = capture_.motion();
    const double offset_s = static_cast<double>(capture_.lidar().clock().status().offset_ns) * 1e-9;
    if (last_ns_ == 0) first_offset_s_ = offset_s;
    seconds_ = static_cast<double>(now_ns - last_ns_) * 1e-9;
    add_rate("lidar packets", now_ns, lidar.accepted);
    add_rate("lidar packets lost", now_ns, lidar.lost);
    add_rate("lidar packets refused", now_ns, lidar.all_refused());
    if (motion.has_imu()) add_rate("IMU messages", now_ns, motion.imu().accepted);
    if (motion.has_imu()) add_rate("IMU messages lost", now_ns, motion.imu().lost);
    if (motion.has_encoder()) add_rate("encoder frames", now_ns, motion.encoder().accepted);
    data_.add("lidar clock against the first second", "ms", now_ns,
              1e3 * (offset_s - first_offset_s_));
    last_ns_ = now_ns;
  }

private:
  void add_rate(std::string_view name, std::int64_t now_ns, std::uint64_t count) {
    std::uint64_t& before = counts_[std::string(name)];
    if (last_ns_ != 0)
      data_.add(name, "1/s", now_ns, static_cast<double>(count - before) / seconds_);
    before = count;
  }

  const PipelineCapture& capture_;
  ReportData& data_;
  std::map<std::string, std::uint64_t> counts_;
  std::int64_t last_ns_ = 0;
  double seconds_ = 0, first_offset_s_ = 0;
};

/// From when to when the sensors contradicted a setting.
class SetupTimes {
public:
  explicit SetupTimes(ReportData& data) : data_(data) {}

  void see(const SetupReport& report, std::int64_t now_ns) {
    for (const SetupFinding& finding : report) {
      auto [at, is_new] =
          open_.try_emplace(finding.fault, ReportEvent{"setup", "", now_ns, now_ns});
      at->second.text = sentence(finding);
      at->second.to_ns = now_ns;
    }
  }
  void finish() {
    for (auto& [fault, event] : open_) data_.add(event);
  }

private:
  ReportData& data_;
  std::map<SetupFault, ReportEvent> open_;
};

void add_ground(const Pipeline& pipeline, ReportData& data) {
  if (!pipeline.uses_map()) return;
  const Mapper& mapper = pipeline.mapper();
  const Pose map{mapper.map().origin(), Eigen::Quaterniond::Identity()};
  data.ground().add(pipeline.ground(), mapper.to_odom() * map);
}

void add_notes(const PipelineCapture& capture, ReportData& data) {
  const velodyne::LidarCounters& lidar = capture.lidar().counters();
  data.note("lidar packets", fmt::format("{} accepted, {} lost, {} refused", lidar.accepted,
                                         lidar.lost, lidar.all_refused()));
  for (std::size_t i = 0; i < velodyne::kRefusals; ++i) {
    if (lidar.refused[i] == 0) continue;
    data.note("lidar packets refused",
              fmt::format("{}: {}", velodyne::kRefusalNames[i], lidar.refused[i]));
  }
  data.note("sweeps", fmt::to_string(lidar.sweeps));
  const MotionCapture& motion = capture.motion();
  data.note("IMU", motion.has_imu() ? fmt::format("{} messages, {} lost", motion.imu().accepted,
                                                  motion.imu().lost)
                                    : "none");
  data.note("encoder",
            motion.has_encoder() ? fmt::format("{} frames", motion.encoder().accepted) : "none");
  data.note("host's clock was set", fmt::format("{} times", lidar.host_steps));
}

}  // namespace

void gather_capture(const std::filesystem::path& capture, const std::filesystem::path& config,
                    ReportData& data) {
  PipelineCapture run(capture, config);
  Pipeline& pipeline = run.pipeline();
  data.stop = run.settings().stop;
  RateLog rates(run, data);
  SetupTimes setup(data);
  std::int64_t ground_ns = 0;
  run.play([&](const Sweep& sweep) {
    const auto begin = std::chrono::steady_clock::now();
    const ObstacleList& list = pipeline.process(sweep);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    if (!sweep.ends_turn && !pipeline.has_looked()) return;
    data.add(list);
    data.add_sweep(pipeline.uses_map() ? pipeline.mapper().sweep().points : pipeline.ground());
    if (pipeline.grid() != nullptr) data.add(*pipeline.grid());
    data.add("time for a list, on this computer", "ms", list.stamp_ns, took.count());
    if (sweep.ends_turn) {
      data.add("returns in a sweep", "", list.stamp_ns, static_cast<double>(sweep.points.size()));
    }
    const PoseFilter& filter = pipeline.mapper().filter();
    if (pipeline.uses_map()) {
      data.add("position, standard deviation", "m", list.stamp_ns,
               filter.position_deviation().head<2>().maxCoeff());
      data.add("heading, standard deviation", "deg", list.stamp_ns,
               degrees(filter.rotation_deviation().z()));
    }
    rates.see(list.stamp_ns);
    setup.see(pipeline.setup(), list.stamp_ns);
    if (list.stamp_ns < ground_ns + kSecondNs) return;
    ground_ns = list.stamp_ns;
    add_ground(pipeline, data);
  });
  add_ground(pipeline, data);
  setup.finish();
  data.find_gaps(run.span().first_ns, run.span().last_ns);
  add_notes(run, data);
}

}  // namespace scree::cli
