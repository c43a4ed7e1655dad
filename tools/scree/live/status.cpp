#include <cstdio>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "common/lcm_options.hpp"
#include "live/health_json.hpp"
#include "live/watch_text.hpp"
#include "scree/publish/subscriber.hpp"

namespace scree::cli {
namespace {

struct StatusOptions {
  LcmOptions lcm;
  bool json = false;
};

/// The next health of a running screed. It comes once a second.
health_t next_health(const std::string& url) {
  std::optional<health_t> health;
  const auto subscriber = value_or_fail(Subscriber::open(
      url, [](const obstacle_list_t&) {}, [&](const health_t& message) { health = message; }));
  constexpr auto kPatience = std::chrono::milliseconds(2500);
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!health && std::chrono::steady_clock::now() < end) {
    constexpr int kPauseMs = 100;
    if (!subscriber->handle(kPauseMs)) throw Failure("LCM stopped receiving on " + url);
  }
  if (!health) {
    throw Failure("no health came on " + url + ": does screed run, and with the same lcm.url?");
  }
  return *health;
}

void status(const StatusOptions& options) {
  const health_t health = next_health(options.lcm.url_of());
  std::string text;
  if (options.json) {
    text = health_json(health) + '\n';
  } else {
    append_text(health, text);
  }
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
  if (health.state != health_t::OK) throw Failure("screed is blind: " + health.reason);
}

}  // namespace

void add_status(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("status", "Print the health of the running screed once; 0: it sees");
  auto options = std::make_shared<StatusOptions>();
  options->lcm.add_to(*command);
  command->add_flag("--json", options->json, "as a JSON object");
  command->callback([options] { status(*options); });
}

}  // namespace scree::cli
