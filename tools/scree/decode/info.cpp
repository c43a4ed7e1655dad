#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "common/time_span.hpp"
#include "decode/info_motion.hpp"
#include "decode/settings_check.hpp"
#include "read/lidar_capture.hpp"
#include "scree/core/ipv4.hpp"
#include "scree/drivers/velodyne/position_packet.hpp"

namespace scree::cli {
namespace {

// In the order of the table, which JSON objects otherwise forget.
using Json = nlohmann::ordered_json;
using velodyne::LidarCounters;
using velodyne::LidarStream;

struct InfoOptions {
  std::string capture, config;
  bool json = false;
};

/// What the position packets say.
struct Position {
  std::uint64_t packets = 0, sentences = 0, fixes = 0;
  std::array<std::uint64_t, velodyne::kPpsNames.size()> pps{};
  std::string last_sentence;

  void see(const Datagram& datagram) {
    const auto position = velodyne::parse_position_packet(datagram.payload);
    if (!position) return;
    ++packets;
    if (position->pps) ++pps[static_cast<std::size_t>(*position->pps)];
    if (!position->gprmc) return;
    ++sentences;
    if (position->gprmc->fix) ++fixes;
    last_sentence = position->sentence;
  }
};

/// How fast the sensor turns, from sweeps that began and ended with a cut.
struct SweepRate {
  std::uint64_t sweeps = 0;
  std::int64_t first_end_ns = 0, last_end_ns = 0, points = 0;

  void see(const Sweep& sweep) {
    points += static_cast<std::int64_t>(sweep.points.size());
    if (sweep.is_standing) return;
    if (sweeps++ == 0) first_end_ns = sweep.end_ns;
    // What is left over at the end of the capture is no turn.
    before_last_end_ns = last_end_ns;
    last_end_ns = sweep.end_ns;
  }
  double per_second() const {
    if (sweeps < 3) return 0;
    return static_cast<double>(sweeps - 2) /
           (static_cast<double>(before_last_end_ns - first_end_ns) * 1e-9);
  }

private:
  std::int64_t before_last_end_ns = 0;
};

double rounded(double value, int digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

Json ports_json(const LidarCapture& capture) {
  Json ports = Json::array();
  for (const auto& [port, traffic] : capture.ports()) {
    Json entry = {{"port", port}, {"datagrams", traffic.datagrams}};
    for (const auto& [size, count] : traffic.sizes) entry["sizes"][std::to_string(size)] = count;
    for (const auto& [sender, count] : traffic.senders) entry["senders"][ipv4_text(sender)] = count;
    ports.push_back(std::move(entry));
  }
  return ports;
}

Json refused_json(const LidarCounters& counters) {
  Json refused = Json::object();
  for (std::size_t i = 0; i < velodyne::kRefusals; ++i) {
    if (counters.refused[i] > 0)
      refused[std::string(velodyne::kRefusalNames[i])] = counters.refused[i];
  }
  return refused;
}

Json describe(const LidarCapture& capture, const LidarStream& stream, const SweepRate& sweep_rate,
              const Position& position, LidarModel model) {
  const LidarCounters& counters = stream.counters();
  const double seconds = capture.seconds();
  const std::uint64_t accepted = counters.accepted;
  Json modes = Json::object();
  constexpr std::array kModes = {"strongest", "last", "dual"};
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    if (counters.by_mode[i] > 0) modes[kModes[i]] = counters.by_mode[i];
  }
  Json pps = Json::object();
  for (std::size_t i = 0; i < velodyne::kPpsNames.size(); ++i) {
    if (position.pps[i] > 0) pps[std::string(velodyne::kPpsNames[i])] = position.pps[i];
  }
  const double rate = sweep_rate.per_second();
  const FrameCounters& frames = capture.frames();
  return {
      {"begin_ns", capture.first_ns()},
      {"seconds", rounded(seconds, 6)},
      {"model", name_of(model)},
      {"return_modes", modes},
      {"packets", accepted},
      {"packets_per_second",
       seconds > 0 ? rounded(static_cast<double>(accepted) / seconds, 1) : 0.0},
      {"lost", counters.lost},
      {"refused", refused_json(counters)},
      {"sweeps", sweep_rate.sweeps},
      {"sweeps_per_second", rounded(rate, 3)},
      {"rpm", rounded(60 * rate, 1)},
      {"points", sweep_rate.points},
      {"points_dropped", counters.dropped},
      {"clock",
       {{"host_minus_device_s",
         rounded(static_cast<double>(stream.clock().status().offset_ns) * 1e-9, 6)},
        {"device_restarts", counters.device_restarts},
        {"host_set_by_s", Json::array()}}},
      {"position",
       {{"packets", position.packets},
        {"pps", pps},
        {"gprmc", position.sentences},
        {"gprmc_with_fix", position.fixes},
        {"last_gprmc", position.last_sentence}}},
      {"ports", ports_json(capture)},
      {"frames",
       {{"not_udp", frames.other},
        {"fragments", frames.fragments},
        {"truncated", frames.truncated}}},
      {"firmware", velodyne::sentence(stream.firmware())},
      {"broken_off", capture.broken_off()},
      {"two_senders", capture.two_senders()},
      {"missing", missing(counters)},
      {"standing", standing(counters)},
  };
}

/// "strongest 1000, dual 3", or `nothing`.
std::string listed(const Json& counts, std::string_view nothing) {
  std::string text;
  for (const auto& [name, count] : counts.items()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.dump());
  }
  return text.empty() ? std::string(nothing) : text;
}

void print_table(const Json& info) {
  const auto row = [](std::string_view name, const std::string& value) {
    fmt::print("{:<14}{}\n", name, value);
  };
  const auto number = [&](const char* key) { return info[key].dump(); };
  row("begins", utc(info["begin_ns"].get<std::int64_t>()));
  row("duration", number("seconds") + " s");
  row("model", info["model"].get<std::string>() + " (by configuration)");
  row("return mode", listed(info["return_modes"], "-"));
  row("packets", fmt::format("{}, {} a second", number("packets"), number("packets_per_second")));
  row("lost", number("lost"));
  row("refused", listed(info["refused"], "none"));
  row("sweeps", fmt::format("{}, {} a second ({} rpm)", number("sweeps"),
                            number("sweeps_per_second"), number("rpm")));
  row("points", number("points"));
  const Json& clock = info["clock"];
  row("clock",
      fmt::format("host minus sensor {} s (within half an hour); sensor restarts {}, host steps {}",
                  clock["host_minus_device_s"].dump(), clock["device_restarts"].dump(),
                  clock["host_steps"].dump()));
  for (const Json& by : clock["host_set_by_s"]) {
    row("", fmt::format("the host's clock was set by {:+.3f} s on the way: taken out",
                        by.get<double>()));
  }
  const Json& position = info["position"];
  row("GPS", fmt::format("{} position packets; PPS {}; GPRMC {}, with fix {}",
                         position["packets"].dump(), listed(position["pps"], "-"),
                         position["gprmc"].dump(), position["gprmc_with_fix"].dump()));
  for (const Json& port : info["ports"]) {
    row(fmt::format("port {}", port["port"].dump()),
        fmt::format("{} datagrams (bytes: {}) from {}", port["datagrams"].dump(),
                    listed(port["sizes"], "-"), listed(port["senders"], "-")));
  }
  row("other frames", listed(info["frames"], "-"));
  for (const Json& mistake : info["settings"]) row("settings", mistake);
  for (const char* key : {"firmware", "broken_off", "two_senders", "missing", "standing"}) {
    if (const std::string note = info[key]; !note.empty()) row("note", note);
  }
}

void inform(const InfoOptions& options) {
  const Settings settings = capture_settings(options.capture, options.config);
  const HostSteps steps = find_host_steps(options.capture, settings.lidar);
  LidarCapture capture(options.capture, settings, steps);
  SweepRate sweep_rate;
  Position position;
  const auto check =
      std::make_unique<SettingsCheck>(options.capture, options.config, settings, steps);
  const auto stream = std::make_unique<LidarStream>(settings.lidar, [&](const Sweep& sweep) {
    sweep_rate.see(sweep);
    check->add(sweep);
  });
  capture.play(
      *stream,
      [&](const Datagram& datagram) {
        if (datagram.destination_port == settings.lidar.position_port) position.see(datagram);
      },
      [&](std::int64_t arrival_ns) { check->play_until(arrival_ns); });
  Json info = describe(capture, *stream, sweep_rate, position, settings.lidar.model);
  info["clock"]["host_steps"] = stream->counters().host_steps + steps.size();
  for (const HostStep& step : steps) {
    info["clock"]["host_set_by_s"].push_back(rounded(static_cast<double>(step.by_ns) * 1e-9, 3));
  }
  info.update(describe_rest(options.capture, options.config, steps, capture.span()));
  info["settings"] = check->finish();
  if (options.json) {
    fmt::print("{}\n", info.dump(2, ' ', false, Json::error_handler_t::replace));
  } else {
    print_table(info);
    print_rest(info);
  }
  if (stream->counters().accepted == 0) throw Failure(capture.why_nothing(*stream));
}

}  // namespace

void add_info(CLI::App& app) {
  CLI::App* const command = app.add_subcommand("info", "What a capture holds");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("capture", options->capture, "Folder, .pcap, .pcapng or LCM log")->required();
  command->add_flag("--json", options->json, "As JSON");
  command->add_option("--config", options->config,
                      "Configuration; the capture's own scree.toml when not given");
  command->callback([options] { inform(*options); });
}

}  // namespace scree::cli
