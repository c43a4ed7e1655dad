#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "common/time_range.hpp"
#include "read/capture_events.hpp"
#include "read/host_steps.hpp"
#include "read/imu_capture.hpp"
#include "read/lidar_capture.hpp"
#include "record/new_capture.hpp"
#include "scoring/truth.hpp"
#include "scree/capture/capture.hpp"
#include "scree/capture/pcap_writer.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct SliceOptions {
  fs::path capture, folder, config;
  TimeRange range;
  Outputs outputs;
};

/// A part of a capture, on the host's clock.
struct Slice {
  std::int64_t start_ns;  ///< of the capture
  TimeRange range;
  HostSteps steps;  ///< are taken out of it

  bool holds(std::int64_t t_ns) const { return range.holds(t_ns - start_ns); }
};

/// The asked-for part. Throws Failure where no sensor says anything in it.
Slice find_slice(const SliceOptions& options, const Settings& settings) {
  CaptureEvents events(options.capture, settings);
  CaptureEvent event;
  std::optional<Slice> slice;
  const HostSteps steps = find_host_steps(options.capture, settings.lidar);
  while (events.next(event)) {
    if (!slice) slice = Slice{event.arrival_ns, options.range, steps};
    if (slice->holds(event.arrival_ns)) return *slice;
  }
  throw Failure(options.range.nothing_in(options.capture.string(),
                                         slice ? event.arrival_ns - slice->start_ns : 0));
}

void copy_records(PcapReader reader, const Slice& slice, const fs::path& file) {
  auto writer = value_or_fail(PcapWriter::create_like(file, reader));
  SteadyTime steady(slice.steps);
  for (PcapRecord record; reader.next(record);) {
    record.arrival_ns = steady(record.arrival_ns);
    if (slice.holds(record.arrival_ns)) writer.write(record);
  }
  if (!reader.broken_off().empty()) fmt::print(stderr, "scree: {}\n", reader.broken_off());
  require(writer.close());
}

/// Packets of an LCM log become datagrams, and so do those of a pcapng file, whose interfaces may
/// have several link types: a pcap file has one.
void copy_lidar(const fs::path& capture, const Settings& settings, const Slice& slice,
                const fs::path& file) {
  const fs::path source = value_or_fail(lidar_file(capture));
  if (!is_lcm_log(source) && !is_pcapng(source)) {
    return copy_records(value_or_fail(PcapReader::open(source)), slice, file);
  }
  LidarFile lidar(source, settings.lidar);
  auto writer = value_or_fail(PcapWriter::create_ethernet(file));
  SteadyTime steady(slice.steps);
  for (Datagram datagram; lidar.next(datagram);) {
    datagram.arrival_ns = steady(datagram.arrival_ns);
    if (slice.holds(datagram.arrival_ns)) writer.write(datagram);
  }
  if (!lidar.broken_off().empty()) fmt::print(stderr, "scree: {}\n", lidar.broken_off());
  require(writer.close());
}

void copy_frames(const fs::path& source, const Slice& slice, const fs::path& file) {
  auto reader = value_or_fail(CanLogReader::open(source));
  auto writer = value_or_fail(CanLogWriter::create(file));
  std::string interface;
  SteadyTime steady(slice.steps);
  for (CanFrame frame; reader.next(frame, &interface);) {
    frame.t_ns = steady(frame.t_ns);
    if (slice.holds(frame.t_ns)) writer.write(frame, interface);
  }
  require(writer.close());
}

/// The poses within and one on either side; the sweeps within, but for one that is cut.
void copy_truth(const fs::path& source, const Slice& slice, const fs::path& file) {
  Truth truth = value_or_fail(read_truth(source));
  const auto is_outside = [&](const auto& entry) { return !slice.holds(entry.t_ns); };
  auto& poses = truth.poses;
  const auto begin = std::ranges::find_if_not(poses, is_outside);
  const auto end = std::find_if(begin, poses.end(), is_outside);
  poses = {begin == poses.begin() ? begin : begin - 1, end == poses.end() ? end : end + 1};

  auto& visible = truth.visible;
  const bool is_cut = !visible.empty() && is_outside(visible.front());
  std::erase_if(visible, is_outside);
  if (is_cut && !visible.empty()) visible.erase(visible.begin());
  require(write_truth(file, truth));
}

void cut(const SliceOptions& options) {
  options.range.check();
  const Settings settings = capture_settings(options.capture, options.config);
  const Slice slice = find_slice(options, settings);
  say(slice.steps);
  const fs::path source = fs::is_directory(options.capture)
                              ? options.capture
                              : fs::absolute(options.capture).parent_path();
  std::error_code none;
  if (fs::equivalent(source, options.folder, none)) {
    throw Failure("a part cannot take the place of the capture that it is cut from");
  }
  const auto config = settings_file(options.capture, options.config);
  make_capture_folder(options.folder, options.outputs, config.value_or(fs::path()));
  if (config) keep_config(*config, options.folder);
  if (lidar_file(options.capture)) {
    copy_lidar(options.capture, settings, slice, options.folder / "lidar.pcap");
  }
  if (!fs::is_directory(options.capture)) return;
  if (imu_file(options.capture)) {
    copy_records(open_imu(options.capture), slice, options.folder / "imu.pcap");
  }
  if (const auto log = can_file(options.capture)) {
    copy_frames(*log, slice, options.folder / "can.log");
  }
  if (const fs::path truth = options.capture / "truth.json"; fs::exists(truth)) {
    copy_truth(truth, slice, options.folder / "truth.json");
  }
}

}  // namespace

void add_slice(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("slice", "Cut a part out of a capture");
  const auto options = std::make_shared<SliceOptions>();
  command->add_option("capture", options->capture, "capture to cut from")
      ->required()
      ->type_name("CAPTURE");
  command->add_option("folder", options->folder, "new folder of the part")
      ->required()
      ->type_name("DIR");
  options->range.add_to(*command);
  command
      ->add_option("--config", options->config,
                   "configuration of the capture [scree.toml in the capture]")
      ->type_name("FILE");
  options->outputs.add_to(*command);
  command->callback([options] { cut(*options); });
}

}  // namespace scree::cli
