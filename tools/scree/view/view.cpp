#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "common/interruption.hpp"
#include "common/lcm_options.hpp"
#include "live/health_json.hpp"
#include "scree/config/settings.hpp"
#include "scree/publish/jsonl.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/subscriber.hpp"
#include "view/server.hpp"

namespace scree::cli {
namespace {

struct ViewOptions {
  LcmOptions lcm;
  ServerOptions server;
};

/// Turns what comes on LCM into what the page reads.
class Viewer {
public:
  explicit Viewer(Hub& hub) : hub_(hub) {}

  void take(const obstacle_list_t& message) {
    from_message(message, list_);
    say(Hub::Kind::list, list_);
  }
  void take(const grid_t& message) {
    if (from_message(message, grid_)) say(Hub::Kind::grid, grid_);
  }
  void take(const health_t& message) { hub_.say(Hub::Kind::health, health_json(message)); }

private:
  template <class What>
  void say(Hub::Kind kind, const What& what) {
    line_.clear();
    append_json_line(what, line_);
    line_.pop_back();  // an event ends with the line
    hub_.say(kind, line_);
  }

  Hub& hub_;
  ObstacleList list_;
  ObstacleGrid grid_;
  std::string line_;
};

void view(const ViewOptions& options) {
  const std::string url = options.lcm.url_of();
  const StopSettings stop = options.lcm.config.empty()
                                ? StopSettings()
                                : value_or_fail(load_settings(options.lcm.config)).stop;
  Hub hub;
  Viewer viewer(hub);
  const auto subscriber = value_or_fail(Subscriber::open(
      url, [&](const obstacle_list_t& list) { viewer.take(list); },
      [&](const health_t& health) { viewer.take(health); },
      [&](const grid_t& grid) { viewer.take(grid); }));
  stop_on_signals();
  const ViewServer server(
      options.server, hub,
      fmt::format(R"({{"version": "{}", "stop": {{"length": {}, "width": {}}}}})", SCREE_VERSION,
                  stop.length, stop.width));
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  constexpr int kPauseMs = 200;
  while (!is_interrupted()) {
    if (!subscriber->handle(kPauseMs)) throw Failure("LCM stopped receiving on " + url);
  }
}

}  // namespace

void add_view(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("view", "Show map, obstacles and health live in the browser");
  auto options = std::make_shared<ViewOptions>();
  options->lcm.add_to(*command);
  command
      ->add_option("--address", options->server.address,
                   "interface to serve on [127.0.0.1: this computer alone]")
      ->type_name("ADDRESS");
  command->add_option("--port", options->server.port, "port to serve on; 0: any [8044]")
      ->check(CLI::Range(0, 65535))
      ->type_name("PORT");
  command->add_option("--token", options->server.token, "only who knows this word gets in")
      ->type_name("WORD")
      ->check([](const std::string& word) {
        const bool is_plain =
            !word.empty() &&
            word.find_first_not_of(
                "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~") ==
                std::string::npos;
        return is_plain ? "" : "letters, digits and -._~ alone";
      });
  command->callback([options] { view(*options); });
}

}  // namespace scree::cli
