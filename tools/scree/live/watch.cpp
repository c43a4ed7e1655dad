#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "commands.hpp"
#include "common/lcm_options.hpp"
#include "live/health_json.hpp"
#include "live/lines_in_place.hpp"
#include "live/watch_text.hpp"
#include "scree/capture/lcm_log.hpp"
#include "scree/publish/jsonl.hpp"
#include "scree/publish/messages.hpp"
#include "scree/publish/subscriber.hpp"

namespace scree::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct WatchOptions {
  LcmOptions lcm;
  std::string log;
  bool json = false, grid = false, health = false;
  int count = 0;
  double seconds = 0, every = 0;
};

/// Prints messages as they come, each at once, so that a pipe behind it sees them too. On a
/// terminal each takes the place of the one of its kind before it.
class Watcher {
public:
  explicit Watcher(const WatchOptions& options)
      : json_(options.json),
        json_health_(options.health),
        in_place_(!options.json && options.log.empty() && isatty(STDOUT_FILENO) != 0),
        pause_(options.every) {}

  void take_list(const obstacle_list_t& message) {
    ++lists_;
    const auto now = Clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::duration_cast<Clock::duration>(pause_);
    from_message(message, list_);
    text_.clear();
    if (json_) {
      append_json_line(list_, text_);
    } else {
      append_text(list_, text_);
    }
    print(Kind::list);
  }
  void take_grid(const grid_t& message) {
    text_.clear();
    append_text(message, text_);
    print(Kind::grid);
  }
  void take_health(const health_t& message) {
    ++healths_;
    if (json_ && !json_health_) return;
    text_.clear();
    if (json_) {
      text_ = health_json(message) + '\n';
    } else {
      append_text(message, text_);
    }
    print(Kind::health);
  }

  /// Says it at the first, and when there are ten times as many.
  void say_refused(std::uint64_t refused) {
    if (refused < refused_to_say_) return;
    refused_to_say_ = 10 * refused;
    std::fprintf(stderr, "scree: %llu messages are malformed, or of another version of Scree\n",
                 static_cast<unsigned long long>(refused));
  }

  int lists() const { return lists_; }
  int healths() const { return healths_; }
  bool has_failed() const { return has_failed_; }

private:
  enum class Kind : std::uint8_t { health, grid, list };  // as they stand on a terminal

  // Called by LCM, which is C: nothing may be thrown here.
  void print(Kind kind) {
    if (in_place_) {
      const auto [rows, columns] = terminal_size();
      screen_.set(static_cast<std::size_t>(kind), text_);
      text_ = screen_.screen(rows, columns);
    }
    std::fwrite(text_.data(), 1, text_.size(), stdout);
    has_failed_ = has_failed_ || std::fflush(stdout) != 0;
  }

  bool json_, json_health_, in_place_;
  LinesInPlace screen_;
  std::chrono::duration<double> pause_;
  Clock::time_point next_{};
  ObstacleList list_;
  std::string text_;
  int lists_ = 0, healths_ = 0;
  std::uint64_t refused_to_say_ = 1;
  bool has_failed_ = false;
};

int milliseconds_until(Clock::time_point end) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1000));
}

std::string nothing_came(const WatchOptions& options, const Watcher& watcher,
                         const std::string& url) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%g s", options.seconds);
  if (watcher.lists() > 0) {
    return "only " + std::to_string(watcher.lists()) + " lists came within " + seconds;
  }
  if (watcher.healths() > 0) {
    return std::string("health came within ") + seconds +
           " but no obstacle list: the daemon sees nothing, and says why in its health and its log";
  }
  return std::string("nothing came within ") + seconds + " on " + url +
         ": does screed run, and with the same lcm.url?";
}

/// What a log of lcm-logger holds.
void watch_log(const WatchOptions& options) {
  LcmLogReader log = value_or_fail(LcmLogReader::open(options.log));
  Watcher watcher(options);
  OnGrid on_grid;
  if (options.grid) on_grid = [&](const grid_t& grid) { watcher.take_grid(grid); };
  MessageDecoder decoder([&](const obstacle_list_t& list) { watcher.take_list(list); },
                         [&](const health_t& health) { watcher.take_health(health); },
                         std::move(on_grid));
  const auto is_enough = [&] { return options.count > 0 && watcher.lists() >= options.count; };
  for (LcmEvent event; !is_enough() && log.next(event);) {
    decoder.take(event.channel, event.message);
    if (watcher.has_failed()) throw Failure("cannot write to standard output");
  }
  watcher.say_refused(decoder.refused());
  if (!log.broken_off().empty()) std::fprintf(stderr, "scree: %s\n", log.broken_off().c_str());
  if (watcher.lists() + watcher.healths() == 0) {
    throw Failure(options.log + ": the log has neither lists nor health of screed");
  }
}

void watch(const WatchOptions& options) {
  if (!options.log.empty()) return watch_log(options);
  const std::string url = options.lcm.url_of();
  Watcher watcher(options);
  Subscriber::OnGrid on_grid;
  if (options.grid) on_grid = [&](const grid_t& grid) { watcher.take_grid(grid); };
  const auto subscriber = Subscriber::open(
      url, [&](const obstacle_list_t& list) { watcher.take_list(list); },
      [&](const health_t& health) { watcher.take_health(health); }, std::move(on_grid));
  if (!subscriber) throw Failure(subscriber.error().message);

  const bool ends = options.seconds > 0;
  const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(ends ? options.seconds : 0));
  const auto is_enough = [&] { return options.count > 0 && watcher.lists() >= options.count; };
  while (!is_enough() && (!ends || Clock::now() < end)) {
    if (!(*subscriber)->handle(ends ? milliseconds_until(end) : 1000)) {
      throw Failure("LCM stopped receiving on " + url);
    }
    watcher.say_refused((*subscriber)->refused());
    if (watcher.has_failed()) throw Failure("cannot write to standard output");
  }
  const bool has_lists = watcher.lists() >= std::max(1, options.count);
  const bool asks_for_lists = options.json || options.count > 0;
  if (!has_lists && (asks_for_lists || watcher.healths() == 0)) {
    throw Failure(nothing_came(options, watcher, url));
  }
}

}  // namespace

void add_watch(CLI::App& app) {
  CLI::App* command = app.add_subcommand("watch", "Print obstacle lists and health as they come");
  auto options = std::make_shared<WatchOptions>();
  options->lcm.add_to(*command);
  command->add_option("LOG", options->log, "a log of lcm-logger, instead of what comes on LCM")
      ->check(CLI::ExistingFile);
  CLI::Option* const json =
      command->add_flag("--json", options->json, "the lists alone, one JSON object a line");
  command->add_flag("--health", options->health, "with --json: health too, with \"health\" in it")
      ->needs(json);
  command
      ->add_flag("--grid", options->grid,
                 "a line for each grid, too: how many cells are free, occupied, a drop, unknown")
      ->excludes(json);
  command->add_option("--count", options->count, "end after this many lists")
      ->check(CLI::Range(1, 1'000'000'000));
  command
      ->add_option("--seconds", options->seconds, "end after this time; it fails if nothing came")
      ->check(CLI::PositiveNumber);
  command->add_option("--every", options->every, "print no more than one list in this time [0]")
      ->type_name("SECONDS")
      ->check(CLI::NonNegativeNumber);
  command->callback([options] { watch(*options); });
}

}  // namespace scree::cli
