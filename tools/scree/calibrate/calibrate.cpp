#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "calibrate/calibration_picture.hpp"
#include "calibrate/drive_capture.hpp"
#include "commands.hpp"
#include "common/fresh_file.hpp"
#include "common/outputs.hpp"
#include "common/temporary_folder.hpp"
#include "read/lidar_capture.hpp"
#include "record/record.hpp"
#include "scree/motion/calibration.hpp"

namespace scree::cli {
namespace {

struct CalibrateOptions {
  std::string capture, config, out, picture, keep;
  double live = 0;  ///< seconds; 0: a capture
  bool json = false;
  Outputs outputs;
};

/// How a value is shown.
struct Row {
  Calibrated which;
  const char *key, *part;
  int decimals;
  const char* unit;
};

constexpr std::array<Row, kCalibrated> kRows = {{
    {Calibrated::lidar_roll, "lidar.rpy_deg", "roll", 2, "deg"},
    {Calibrated::lidar_pitch, "lidar.rpy_deg", "pitch", 2, "deg"},
    {Calibrated::lidar_yaw, "lidar.rpy_deg", "yaw", 2, "deg"},
    {Calibrated::lidar_x, "lidar.translation", "x", 3, "m"},
    {Calibrated::lidar_height, "lidar.translation", "z", 3, "m"},
    {Calibrated::imu_roll, "imu.rpy_deg", "roll", 2, "deg"},
    {Calibrated::imu_pitch, "imu.rpy_deg", "pitch", 2, "deg"},
    {Calibrated::imu_yaw, "imu.rpy_deg", "yaw", 2, "deg"},
    {Calibrated::imu_delay, "imu.delay", "", 3, "s"},
    {Calibrated::encoder_scale, "encoder.scale", "", 8, ""},
    {Calibrated::encoder_y, "encoder.translation", "y", 3, "m"},
    {Calibrated::encoder_delay, "encoder.delay", "", 3, "s"},
}};

std::string verdict(const Calibration& found, const Settings& set, Calibrated which) {
  if (const auto why = found[which].why_not; !why.empty()) return "not shown: " + std::string(why);
  if (!contradicts(found, set, which)) return "agrees";
  const double after = set_value(with_calibration(set, found), which);
  return after == set_value(set, which) ? "contradicts; not written, not all angles are shown"
                                        : "contradicts";
}

void print_table(const Calibration& found, const Settings& set) {
  fmt::print("{:<26}{:>12}{:>12}{:>12}\n", "", "set", "found", "+-");
  for (const Row& row : kRows) {
    const CalibratedValue& value = found[row.which];
    const std::string name = fmt::format("{} {}", row.key, row.part);
    const auto number = [&](double of) { return fmt::format("{:.{}f}", of, row.decimals); };
    const bool is_shown = value.why_not.empty();
    fmt::print("{:<26}{:>12}{:>12}{:>12} {:<4} {}\n", name, number(set_value(set, row.which)),
               is_shown ? number(value.value) : "-", is_shown ? number(value.deviation) : "-",
               row.unit, verdict(found, set, row.which));
  }
}

void print_json(const Calibration& found, const Settings& set) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const Row& row : kRows) {
    const CalibratedValue& value = found[row.which];
    nlohmann::ordered_json each = {{"key", row.key},
                                   {"part", row.part},
                                   {"unit", row.unit},
                                   {"set", set_value(set, row.which)}};
    if (value.why_not.empty()) {
      each["found"] = value.value;
      each["deviation"] = value.deviation;
      each["contradicts"] = contradicts(found, set, row.which);
    } else {
      each["not_shown"] = value.why_not;
    }
    values.push_back(std::move(each));
  }
  fmt::print("{}\n", values.dump(2));
}

/// The keys in which these settings differ from those, as TOML.
std::string drop_in(const Settings& settings, const Settings& from) {
  const auto list = [](const char* key, const Eigen::Vector3d& is, const Eigen::Vector3d& was,
                       int decimals) -> std::string {
    if (is == was) return "";
    return fmt::format("{} = [{:.{}f}, {:.{}f}, {:.{}f}]\n", key, is.x(), decimals, is.y(),
                       decimals, is.z(), decimals);
  };
  const std::string lidar =
      list("translation", settings.lidar.translation, from.lidar.translation, 3) +
      list("rpy_deg", settings.lidar.rpy_deg, from.lidar.rpy_deg, 2);
  const auto delay = [](double is, double was) {
    return is == was ? "" : fmt::format("delay = {:.3f}\n", is);
  };
  const std::string imu = list("rpy_deg", settings.imu.rpy_deg, from.imu.rpy_deg, 2) +
                          delay(settings.imu.delay, from.imu.delay);
  const std::string encoder =
      (settings.encoder.scale == from.encoder.scale
           ? ""
           : fmt::format("scale = {:.6g}\n", settings.encoder.scale)) +
      list("translation", settings.encoder.translation, from.encoder.translation, 3) +
      delay(settings.encoder.delay, from.encoder.delay);
  std::string text = "# What a drive showed of the mounts: by `scree calibrate`.\n";
  if (!lidar.empty()) text += "[lidar]\n" + lidar;
  if (!imu.empty()) text += "[imu]\n" + imu;
  if (!encoder.empty()) text += "[encoder]\n" + encoder;
  return text;
}

/// @param config empty for the capture's own
void calibrate_capture(const CalibrateOptions& options, const std::string& capture,
                       const std::string& config) {
  const Settings set = capture_settings(capture, config);
  const DriveCapture drive = read_drive(capture, config, set);
  const Calibration found = calibrate(drive.record, set);
  const bool shows_nothing = std::ranges::none_of(
      found.values, [](const CalibratedValue& value) { return value.why_not.empty(); });
  if (shows_nothing) {
    throw Failure(capture + ": the drive shows nothing of the mounts: " +
                  std::string(found.values[0].why_not));
  }
  const Settings after = with_calibration(set, found);
  if (options.json) {
    print_json(found, set);
  } else {
    print_table(found, set);
  }
  if (!options.picture.empty()) {
    draw_calibration(drive, set, after).write_png(options.picture);
  }
  if (!options.out.empty()) write_whole(options.out, drop_in(after, set));
}

/// The drive that is now, by way of a capture.
void calibrate_live(const CalibrateOptions& options) {
  const std::string config = options.config.empty() ? kConfigOfRobot : options.config;
  options.outputs.require_free({options.out, options.picture}, {config});
  fmt::print(stderr,
             "scree: drive now for {:.0f} s: bends and turns on the spot to both sides, bumps, "
             "starts and stops; Ctrl-C ends it earlier\n",
             options.live);
  std::optional<TemporaryFolder> temporary;
  std::string folder = options.keep;
  if (folder.empty()) folder = temporary.emplace("scree-drive").path();
  record_sensors(config, folder, options.live, options.outputs);
  calibrate_capture(options, folder, "");
}

void run_calibrate(const CalibrateOptions& options) {
  if (!options.picture.empty()) require_cairo();
  if (options.live > 0) return calibrate_live(options);
  if (options.capture.empty()) throw CLI::RequiredError("CAPTURE or --live");
  options.outputs.require_free({options.out, options.picture}, {options.capture, options.config});
  calibrate_capture(options, options.capture, options.config);
}

}  // namespace

void add_calibrate(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "calibrate", "Mounts, encoder scale and delays from a minute of driving with turns");
  const auto options = std::make_shared<CalibrateOptions>();
  CLI::Option* const capture =
      command
          ->add_option("capture", options->capture,
                       "folder, as `scree record` and `scree simulate` write it")
          ->type_name("CAPTURE");
  CLI::Option* const live =
      command
          ->add_option("--live", options->live,
                       "drive now, for so long, instead of a capture; screed must not run")
          ->type_name("SECONDS")
          ->check(CLI::PositiveNumber)
          ->excludes(capture);
  command->add_option("--keep", options->keep, "new folder in which the recording of --live stays")
      ->type_name("DIR")
      ->needs(live);
  command->add_option("--config", options->config,
                      fmt::format("configuration; when not given the capture's own scree.toml, or "
                                  "with --live {}",
                                  kConfigOfRobot));
  command
      ->add_option("--out", options->out,
                   "a drop-in with what the drive contradicts, for scree.d beside scree.toml")
      ->type_name("FILE.toml");
  command->add_option("--picture", options->picture, "the drive before and after")
      ->type_name("FILE.png");
  command->add_flag("--json", options->json, "as JSON");
  options->outputs.add_to(*command);
  command->callback([options] { run_calibrate(*options); });
}

}  // namespace scree::cli
