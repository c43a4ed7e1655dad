#include "doctor/check_system.hpp"

#include <linux/capability.h>
#include <spdlog/fmt/fmt.h>
#include <sys/timex.h>

#include <algorithm>

#include "doctor/proc_text.hpp"

namespace scree {
namespace {

// What the readers ask for, and what screed takes with room to spare; screed.service allows them.
constexpr std::uint64_t kPriority = 40, kLockedBytes = std::uint64_t{512} << 20;

constexpr const char* kByHand = "the service may (screed.service), started by hand screed may not";

}  // namespace

Rights rights_of(std::string_view limits, std::string_view status) {
  Rights rights;
  rights.priority = has_capability(status, CAP_SYS_NICE)
                        ? kUnlimited
                        : parse_limit(limits, "Max realtime priority").value_or(0);
  rights.locked_bytes = has_capability(status, CAP_IPC_LOCK)
                            ? kUnlimited
                            : parse_limit(limits, "Max locked memory").value_or(0);
  return rights;
}

Finding check_priority(const Running& screed, const Rights& own) {
  const std::string subject = "real time";
  if (screed.is_running) {
    return screed.has_real_time
               ? ok(subject, "the sensors' threads of screed come first")
               : wrong(subject,
                       "the sensors' threads of screed run as other programs do: start it "
                       "as the service, or allow the priority with `ulimit -r 40`");
  }
  if (own.priority >= kPriority) return ok(subject, "this user may set the priority");
  return wrong(subject, fmt::format("this user may not set priority {}: {}, without `@dialout - "
                                    "rtprio {}` in /etc/security/limits.d/scree.conf",
                                    kPriority, kByHand, kPriority));
}

Finding check_memory(const Running& screed, const Rights& own) {
  const std::string subject = "memory";
  if (screed.is_running) {
    return screed.locked_kilobytes > 0
               ? ok(subject, fmt::format("screed has locked {} MB", screed.locked_kilobytes / 1024))
               : wrong(subject,
                       "screed's memory is not locked, its pages may be swapped out: start "
                       "it as the service, or allow it with `ulimit -l unlimited`");
  }
  if (own.locked_bytes >= kLockedBytes) return ok(subject, "this user may lock it");
  return wrong(subject,
               fmt::format("this user may lock only {} MB: {}, without `@dialout - memlock "
                           "unlimited` in /etc/security/limits.d/scree.conf",
                           own.locked_bytes >> 20, kByHand));
}

Finding check_clock(int state, std::int64_t error_us) {
  const std::string subject = "clock";
  if (state == TIME_ERROR) {
    return wrong(subject,
                 "nothing sets this computer's clock, so times of lists are off from those "
                 "of others: install chrony, or systemctl enable --now systemd-timesyncd");
  }
  return ok(subject, fmt::format("it is set by others, and off by {:.1f} ms at most",
                                 static_cast<double>(error_us) * 1e-3));
}

Finding check_serial(const std::string& device, const SerialFacts& facts) {
  const std::string subject = "serial port";
  if (!facts.exists) {
    return wrong(subject,
                 fmt::format("there is no {}: plug the IMU in, or set imu.device to one of "
                             "/dev/serial/by-id, /dev/ttyUSB* or /dev/ttyACM*",
                             device));
  }
  if (!facts.is_terminal) return wrong(subject, device + " is no serial port: set imu.device");
  if (!facts.may_use) {
    return wrong(subject, fmt::format("no right to {0}: `sudo usermod -aG {1} $USER`, and log in "
                                      "anew (the service is in the group dialout)",
                                      device, facts.group));
  }
  constexpr int kLate = 1;
  if (facts.latency_timer.value_or(0) > kLate) {
    return wrong(subject,
                 fmt::format("{} hands bytes on only every {} ms: echo 1 > {} (the package's "
                             "udev rule does so)",
                             device, *facts.latency_timer, facts.timer_file));
  }
  return ok(subject, fmt::format("{} may be opened{}", device,
                                 facts.latency_timer ? ", and hands bytes on after 1 ms" : ""));
}

Finding check_sensor(const std::string& subject, const sensor_health_t& health,
                     const std::string& advice) {
  const std::string source = health.source.empty() ? "" : " from " + health.source;
  switch (health.state) {
    case sensor_health_t::OK:
      return ok(subject, fmt::format("{:.0f} messages a second{}", health.rate, source));
    case sensor_health_t::SLOW:
      return wrong(subject, fmt::format("only {:.0f} of {:.0f} messages a second come{}: {}",
                                        health.rate, health.expected_rate, source, advice));
    case sensor_health_t::WRONG_DATA: {
      const auto most = std::ranges::max_element(health.refused);
      const std::string reason =
          most == health.refused.end()
              ? "of another kind"
              : health.refused_reason[static_cast<std::size_t>(most - health.refused.begin())];
      return wrong(subject,
                   fmt::format("what comes{} is refused ({}): {}", source, reason, advice));
    }
    case sensor_health_t::SILENT:
      return wrong(subject, fmt::format("nothing comes{} any more: {}", source, advice));
    default:
      return wrong(subject, "nothing has come: " + advice);
  }
}

}  // namespace scree
