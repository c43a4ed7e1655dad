#include "decode/info_motion.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "commands.hpp"
#include "read/encoder_capture.hpp"
#include "read/imu_capture.hpp"
#include "read/lidar_capture.hpp"
#include "read/motion_capture.hpp"
#include "scoring/truth.hpp"
#include "scree/capture/capture.hpp"

namespace scree::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

double rounded(double value) {
  return std::round(value * 1000) / 1000;
}

double seconds_of(const TimeSpan& span) {
  return span.empty() ? 0 : static_cast<double>(span.last_ns - span.first_ns) * 1e-9;
}

double rate_of(std::uint64_t count, double seconds) {
  return seconds > 0 ? rounded(static_cast<double>(count) / seconds) : 0;
}

template <class Counts, class Names>
Json refused_of(const Counts& counts, const Names& reasons) {
  Json refused = Json::object();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) refused[std::string(reasons[i])] = counts[i];
  }
  return refused;
}

Json describe_imu(const fs::path& capture, const Settings& settings, const HostSteps& steps,
                  const TimeSpan& lidar) {
  ImuCapture imu(capture, steps);
  xsens::ImuStream stream(settings.imu, {});
  imu.play(stream);
  const xsens::ImuCounters& counters = stream.counters();
  const double seconds = imu.seconds();
  return {{"messages", counters.accepted},
          {"messages_per_second", rate_of(counters.accepted, seconds)},
          {"seconds", rounded(seconds)},
          {"with_orientation", counters.oriented},
          {"lost", counters.lost},
          {"refused", refused_of(counters.refused, xsens::kRefusalReasons)},
          {"bytes_skipped", counters.bytes_skipped},
          {"device_restarts", counters.device_restarts},
          {"other_clock", note_of_other_clock("IMU's bytes", imu.span(), lidar)},
          {"broken_off", imu.broken_off()}};
}

Json describe_encoder(const fs::path& capture, const fs::path& config, const HostSteps& steps,
                      const TimeSpan& lidar) {
  const EncoderSettings settings = encoder_settings(capture, config);
  EncoderCapture encoder(capture, settings, steps);
  double first = 0, last = 0;
  std::uint64_t samples = 0;
  encoder::EncoderStream stream(settings, [&](const EncoderSample& sample) {
    if (samples++ == 0) first = sample.distance;
    last = sample.distance;
  });
  encoder.play(stream);
  const encoder::EncoderCounters& counters = stream.counters();
  const double seconds = seconds_of(encoder.span());
  return {{"interface", settings.interface},
          {"samples", samples},
          {"samples_per_second", rate_of(samples, seconds)},
          {"seconds", rounded(seconds)},
          {"distance_m", rounded(last - first)},
          {"refused", refused_of(counters.refused, encoder::kRefusalReasons)},
          {"other_frames", counters.other},
          {"other_clock", note_of_other_clock("encoder's frames", encoder.span(), lidar)},
          {"why_nothing", samples == 0 ? encoder.why_nothing(stream) : ""}};
}

Json describe_truth(const fs::path& file) {
  const Truth truth = value_or_fail(read_truth(file));
  const auto rocks = std::ranges::count(truth.obstacles, ObstacleKind::positive,
                                        [](const TrueObstacle& it) { return it.kind; });
  const auto moving = std::ranges::count_if(truth.obstacles, &TrueObstacle::moves);
  double way = 0;
  for (std::size_t i = 1; i < truth.poses.size(); ++i) {
    way += (truth.poses[i].base.translation - truth.poses[i - 1].base.translation).norm();
  }
  return {{"positive", rocks},
          {"negative", static_cast<std::ptrdiff_t>(truth.obstacles.size()) - rocks},
          {"moving", moving},
          {"poses", truth.poses.size()},
          {"sweeps", truth.visible.size()},
          {"way_m", rounded(way)}};
}

/// One sensor's fault must not hide the others.
template <class Describe>
Json or_fault(const Describe& describe) {
  try {
    return describe();
  } catch (const Failure& failure) {
    return {{"fault", failure.what()}};
  }
}

std::string listed(const Json& counts) {
  std::string text;
  for (const auto& [name, count] : counts.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.dump());
  }
  return text.empty() ? "none" : text;
}

}  // namespace

Json describe_rest(const fs::path& capture, const fs::path& config, const HostSteps& steps,
                   const TimeSpan& lidar) {
  Json rest = {{"imu", nullptr}, {"encoder", nullptr}, {"truth", nullptr}};
  if (!fs::is_directory(capture)) return rest;
  const Settings settings = capture_settings(capture, config);
  if (imu_file(capture)) {
    rest["imu"] = or_fault([&] { return describe_imu(capture, settings, steps, lidar); });
  }
  if (can_file(capture)) {
    rest["encoder"] = or_fault([&] { return describe_encoder(capture, config, steps, lidar); });
  }
  if (const fs::path file = capture / "truth.json"; fs::exists(file)) {
    rest["truth"] = or_fault([&] { return describe_truth(file); });
  }
  return rest;
}

void print_rest(const Json& info) {
  const auto row = [&](const char* key, const char* name, const auto& text) {
    const Json& part = info[key];
    if (part.is_null()) return;
    const bool has_fault = part.contains("fault");
    fmt::print("{:<14}{}\n", name, has_fault ? part["fault"].get<std::string>() : text(part));
    const std::string other_clock = part.value("other_clock", "");
    if (!other_clock.empty()) fmt::print("{:<14}{}\n", "note", other_clock);
  };
  row("imu", "IMU", [](const Json& imu) {
    return fmt::format("{} messages, {} a second, {} with orientation; lost {}; refused {}",
                       imu["messages"].dump(), imu["messages_per_second"].dump(),
                       imu["with_orientation"].dump(), imu["lost"].dump(), listed(imu["refused"]));
  });
  row("encoder", "encoder", [](const Json& encoder) {
    if (std::string why = encoder["why_nothing"]; !why.empty()) return why;
    return fmt::format("{} samples, {} a second; rolled {} m; refused {}",
                       encoder["samples"].dump(), encoder["samples_per_second"].dump(),
                       encoder["distance_m"].dump(), listed(encoder["refused"]));
  });
  row("truth", "truth", [](const Json& truth) {
    return fmt::format("{} positive, {} negative obstacles ({} of them move); {} sweeps, {} m",
                       truth["positive"].dump(), truth["negative"].dump(), truth["moving"].dump(),
                       truth["sweeps"].dump(), truth["way_m"].dump());
  });
}

}  // namespace scree::cli
