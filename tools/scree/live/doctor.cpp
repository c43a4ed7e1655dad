#include <spdlog/fmt/fmt.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "doctor/firewall.hpp"
#include "doctor/listening.hpp"
#include "doctor/probes.hpp"
#include "scree/core/ipv4.hpp"
#include "scree/drivers/encoder/dbc.hpp"
#include "scree/drivers/gpio/lines.hpp"
#include "scree/publish/multicast.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct DoctorOptions {
  std::string config = kConfigOfRobot;
  double seconds = 3;
  bool json = false;
};

std::string named(const Process& process) {
  return process.id == 0 ? "a program of another user (as root this says which)"
                         : fmt::format("{} (process {})", process.name, process.id);
}

class Doctor {
public:
  explicit Doctor(const DoctorOptions& options) : options_(options) {}

  /// Looks at everything, and prints a line for each. @return how many are wrong
  int examine() {
    read_config();
    find_screed();
    Listening listening(settings_, is_running());
    // Health comes once a second.
    constexpr double kHealth = 1.3;
    listening.listen(screed_ ? std::max(options_.seconds, kHealth) : options_.seconds);
    check_daemon(listening);
    check_multicast();
    check_lidar(listening);
    check_imu(listening);
    check_encoder(listening);
    check_lines();
    check_computer();
    return static_cast<int>(
        std::ranges::count(findings_, Finding::Verdict::wrong, &Finding::verdict));
  }
  void print() const {
    constexpr std::array kVerdicts = {"ok", "WRONG", "?"};
    for (const Finding& finding : findings_) {
      fmt::print("{:<6}{:<14} {}\n", kVerdicts[static_cast<std::size_t>(finding.verdict)],
                 finding.subject, finding.text);
    }
  }
  void print_json() const {
    constexpr std::array kVerdicts = {"ok", "wrong", "unknown"};
    auto findings = nlohmann::ordered_json::array();
    for (const Finding& finding : findings_) {
      findings.push_back({{"subject", finding.subject},
                          {"verdict", kVerdicts[static_cast<std::size_t>(finding.verdict)]},
                          {"text", finding.text}});
    }
    using nlohmann::json;
    fmt::print("{}\n", findings.dump(2, ' ', false, json::error_handler_t::replace));
  }
  std::size_t count() const { return findings_.size(); }

private:
  void add(Finding finding) { findings_.push_back(std::move(finding)); }
  bool is_running() const { return screed_.has_value(); }

  void read_config() {
    auto loaded = load_settings(options_.config);
    if (!loaded) {
      const std::string goes_on = "; until --config names one this goes by the defaults";
      return add(wrong("configuration", loaded.error().message + goes_on));
    }
    const auto encoder = encoder::with_dbc(loaded->encoder, options_.config);
    settings_ = std::move(*loaded);
    if (!encoder) return add(wrong("configuration", encoder.error().message));
    settings_.encoder = *encoder;
    add(ok("configuration", options_.config));
  }

  /// A screed with another configuration is none.
  void find_screed() {
    owner_ = owner_of_port(settings_.lidar.port);
    position_owner_ = owner_of_port(settings_.lidar.position_port);
    if (owner_ && owner_->process.name == "screed") screed_ = owner_->process;
  }

  void check_port(const char* subject, const char* key, int port,
                  const std::optional<PortOwner>& owner) {
    if (!owner) return add(ok(subject, fmt::format("UDP port {} is free", port)));
    const std::string where = fmt::format("{}:{}", ipv4_text(owner->address), port);
    if (owner->process.name == "screed") {
      return add(ok(subject, fmt::format("{} is bound by {}", where, named(owner->process))));
    }
    add(wrong(subject, fmt::format("{} is taken by {}: end it, or set {}", where,
                                   named(owner->process), key)));
  }

  void check_daemon(const Listening& listening) {
    if (!owner_ && !listening.port_problem().empty()) {
      add(wrong("UDP port", listening.port_problem()));
    } else {
      check_port("UDP port", "lidar.port", settings_.lidar.port, owner_);
    }
    const int position = settings_.lidar.position_port;
    check_port("position port", "lidar.position_port", position, position_owner_);
    if (!screed_) return add(ok("screed", "it does not run: this looks at the sensors itself"));
    if (const auto& health = listening.health()) {
      add(health->state == health_t::OK ? ok("screed", "it runs, and sees")
                                        : wrong("screed", "it is blind: " + health->reason));
      for (const std::string& mistake : health->setup) add(wrong("settings", mistake));
      return;
    }
    add(wrong("screed", fmt::format("it runs, but its health does not come on {}: has its "
                                    "configuration another lcm.url?",
                                    settings_.lcm.url)));
  }

  void check_multicast() {
    const auto routed = scree::check_multicast(settings_.lcm.url);
    add(routed ? ok("LCM", settings_.lcm.url + " has a route")
               : wrong("LCM", routed.error().message));
  }

  void check_lidar(const Listening& listening) {
    const auto& health = listening.health();
    const bool comes = health && health->lidar.state != sensor_health_t::NEVER_SEEN &&
                       health->lidar.state != sensor_health_t::SILENT;
    const Finding lidar =
        comes ? check_sensor("lidar", health->lidar, "look at lidar.model and at the network")
              : check_lidar_traffic(settings_.lidar, listening.lidar());
    const bool is_well = lidar.verdict == Finding::Verdict::ok;
    if (owner_ && !screed_) {
      add(unknown("lidar", "it cannot be heard while another program has its port"));
    } else {
      add(lidar);
    }
    if (is_well) return add(ok("firewall", "packets of the lidar come through"));
    if (geteuid() != 0) {
      return add(unknown("firewall", "only root may read its rules: sudo scree doctor"));
    }
    const std::string programs = output_of("command -v nft iptables");
    if (programs.empty()) {
      return add(unknown("firewall", "neither nft nor iptables is installed to read its rules"));
    }
    add(check_firewall(output_of("nft list ruleset 2> /dev/null"),
                       output_of("iptables -S INPUT 2> /dev/null"), settings_.lidar.port));
  }

  void check_imu(const Listening& listening) {
    const std::string& device = settings_.imu.device;
    if (device.empty()) return add(ok("IMU", "imu.device is empty: there is none"));
    const Finding port = check_serial(device, look_at_serial(device));
    add(port);
    if (is_running()) {
      if (const auto& health = listening.health()) {
        add(check_sensor("IMU", health->imu, "check its cable and power, and imu.baud"));
      }
      return;
    }
    const auto user = listening.imu_measures() ? std::nullopt : user_of_device(device);
    if (user) {
      return add(wrong("IMU", fmt::format("{} has {} open: end it", named(*user), device)));
    }
    if (port.verdict == Finding::Verdict::ok || listening.imu_measures()) add(listening.imu());
  }

  void check_encoder(const Listening& listening) {
    const std::string& interface = settings_.encoder.interface;
    if (interface.empty()) {
      return add(ok("encoder", "encoder.interface is empty: there is none"));
    }
    const Finding link = check_can_link(interface, look_at_can(interface));
    add(link);
    if (const auto& traffic = listening.encoder()) {
      add(check_can_traffic(interface, settings_.encoder.can_id, *traffic));
    }
  }

  void check_lines() {
    const GpioSettings& gpio = settings_.gpio;
    const std::array<std::pair<const char*, std::string>, 3> lines = {
        {{"gpio.pps", gpio.pps}, {"gpio.stop", gpio.stop}, {"gpio.heartbeat", gpio.heartbeat}}};
    bool is_any = false;
    for (const auto& [key, name] : lines) {
      if (name.empty()) continue;
      is_any = true;
      const auto holder = gpio::holder_of(name);
      if (!holder) {
        add(wrong(key, name + ": " + holder.error().message));
      } else if (holder->empty() || (is_running() && *holder == "scree")) {
        add(ok(key, fmt::format("{} is {}", name, holder->empty() ? "free" : "held by screed")));
      } else {
        add(wrong(key,
                  fmt::format("{} is held by {}: end it, or choose another line", name, *holder)));
      }
    }
    if (!is_any) add(ok("GPIO lines", "none is configured"));
  }

  void check_computer() {
    const Running screed = how_runs(screed_);
    const Rights own = rights_of(read_text("/proc/self/limits"), read_text("/proc/self/status"));
    add(check_priority(screed, own));
    add(check_memory(screed, own));
    timex clock{};
    const int state = adjtimex(&clock);
    add(check_clock(state, clock.maxerror));
  }

  DoctorOptions options_;
  Settings settings_;
  std::optional<PortOwner> owner_, position_owner_;  // of the lidar's ports, before listening
  std::optional<Process> screed_;                    // the same, where it is screed
  std::vector<Finding> findings_;
};

void examine(const DoctorOptions& options) {
  Doctor doctor(options);
  const int wrong = doctor.examine();
  options.json ? doctor.print_json() : doctor.print();
  std::fflush(stdout);
  if (wrong > 0) throw Failure(fmt::format("{} of {} are wrong", wrong, doctor.count()));
}

}  // namespace

void add_doctor(CLI::App& app) {
  CLI::App* const command = app.add_subcommand(
      "doctor", "What to do when nothing comes: sensors, network, rights, clock");
  const auto options = std::make_shared<DoctorOptions>();
  command->add_option("--config", options->config, "configuration of the robot")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "how long to listen")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "as a JSON array, an object for each line");
  command->callback([options] { examine(*options); });
}

}  // namespace scree::cli
