#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "common/interruption.hpp"
#include "common/lcm_options.hpp"
#include "live/terminal.hpp"
#include "live/top_page.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/subscriber.hpp"

namespace scree::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

/// What came last, and when.
class Seen {
public:
  explicit Seen(const std::string& url) { view_.url = url; }

  void take(const obstacle_list_t& message) {
    if (!view_.list) view_.list.emplace();
    from_message(message, *view_.list);
    list_at_ = Clock::now();
  }
  void take(const health_t& message) {
    view_.health = message;
    health_at_ = Clock::now();
  }
  const TopView& view(std::uint64_t refused) {
    view_.refused = refused;
    view_.waited = seconds_since(start_);
    view_.list_age = seconds_since(list_at_);
    view_.health_age = seconds_since(health_at_);
    return view_;
  }

private:
  TopView view_;
  Clock::time_point start_ = Clock::now(), list_at_ = start_, health_at_ = start_;
};

void top(const LcmOptions& options) {
  const std::string url = options.url_of();
  Seen seen(url);
  const auto subscriber = value_or_fail(Subscriber::open(
      url, [&](const obstacle_list_t& list) { seen.take(list); },
      [&](const health_t& health) { seen.take(health); }));
  stop_on_signals();
  Terminal terminal;
  constexpr int kEscape = 27, kPauseMs = 100;
  for (int key = 0; !is_interrupted() && key != 'q' && key != 'Q' && key != kEscape;
       key = terminal.key()) {
    terminal.draw(top_page(seen.view(subscriber->refused()), terminal.rows(), terminal.columns()));
    if (!subscriber->handle(kPauseMs)) throw Failure("LCM stopped receiving on " + url);
  }
}

}  // namespace

void add_top(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "top", "Show sensors, times, queues and obstacles in the terminal, as they come; q ends it");
  auto options = std::make_shared<LcmOptions>();
  options->add_to(*command);
  command->callback([options] { top(*options); });
}

}  // namespace scree::cli
