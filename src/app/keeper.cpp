#include "keeper.hpp"

#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <scree/health_t.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "health_watch.hpp"
#include "metrics_text.hpp"
#include "scree/clock/clocks.hpp"
#include "scree/publish/publisher.hpp"

namespace scree {
namespace {

constexpr std::size_t kMessages = 24;            // a second of lists and grids
constexpr std::size_t kLongestMessage = 65'536;  // longer ones make room for themselves
constexpr std::size_t kPackets = 512;            // two thirds of a second
constexpr std::size_t kLongestPacket = 2048;
constexpr std::chrono::milliseconds kPause{50};

constexpr std::string_view kPacketChannel = "VELODYNE";

}  // namespace

Result<std::unique_ptr<Keeper>> Keeper::start(const Settings& settings) {
  std::optional<BlackBox> box;
  if (!settings.blackbox.folder.empty()) {
    auto opened = BlackBox::open(settings.blackbox, wall_ns());
    if (!opened) return tl::make_unexpected(opened.error());
    box.emplace(std::move(*opened));
    spdlog::info("the black box keeps {:g} s in {}", settings.blackbox.seconds,
                 settings.blackbox.folder);
  }
  if (!box && settings.metrics.file.empty()) return nullptr;
  return std::unique_ptr<Keeper>(
      new Keeper(std::move(box), settings.metrics.file, settings.blackbox.packets));
}

Keeper::Keeper(std::optional<BlackBox> box, std::string metrics_file, bool keeps_packets)
    : box_(std::move(box)),
      metrics_file_(std::move(metrics_file)),
      keeps_packets_(keeps_packets && box_),
      messages_(kMessages, [] { return KeptMessage(kLongestMessage); }),
      packets_(keeps_packets_ ? kPackets : 1, [] { return KeptMessage(kLongestPacket); }),
      thread_([this] { run(); }) {
  pthread_setname_np(thread_.native_handle(), "keeper");
}

Keeper::~Keeper() {
  is_stopped_ = true;
  messages_.wake();
  thread_.join();
}

bool Keeper::fill(Pool& pool, std::string_view channel, std::span<const std::uint8_t> bytes) {
  KeptMessage* const message = pool.acquire();
  if (message == nullptr) return false;
  message->channel = channel;
  message->time_ns = wall_ns();
  message->bytes.assign(bytes.begin(), bytes.end());
  pool.push(message);
  return true;
}

void Keeper::put(std::string_view channel, std::span<const std::uint8_t> message) {
  if (!fill(messages_, channel, message)) ++dropped_;
}

void Keeper::put_packet(std::span<const std::uint8_t> datagram) {
  if (!keeps_packets_ || datagram.size() > kLongestPacket) return;
  if (!fill(packets_, kPacketChannel, datagram)) ++dropped_;
}

void Keeper::run() {
  while (!is_stopped_) {
    messages_.wait(kPause);
    drain(packets_);
    drain(messages_);
    if (!box_) continue;
    box_->look_for_mark(wall_ns());
    say(said_of_box_, box_->problem());
  }
  drain(packets_);
  drain(messages_);
  if (box_) box_->close("end", wall_ns());
}

void Keeper::drain(Pool& pool) {
  while (KeptMessage* const message = pool.pop()) {
    take(*message);
    pool.release(message);
  }
  if (const std::uint64_t dropped = dropped_; dropped >= 10 * dropped_said_ + 1) {
    spdlog::warn("{} messages found no room in the black box: its disk is slow", dropped);
    dropped_said_ = dropped;
  }
}

void Keeper::take(const KeptMessage& message) {
  if (box_) box_->take(message.channel, message.time_ns, message.bytes);
  if (message.channel == kHealthChannel) take_health(message);
}

void Keeper::take_health(const KeptMessage& message) {
  health_t health;
  if (health.decode(message.bytes.data(), 0, static_cast<int>(message.bytes.size())) < 0) return;
  if (!metrics_file_.empty()) write_metrics(metrics_text(health));
  if (health.reason == HealthWatch::kWasStopped) return;  // the ring is closed as "end"
  const bool is_blind = health.state != health_t::OK, is_stop = health.stop != 0;
  if (box_ && is_blind && !was_blind_) {
    box_->close_for_state("blind", message.time_ns);
  } else if (box_ && is_stop && !was_stopped_) {
    box_->close_for_state("stop", message.time_ns);
  }
  was_blind_ = is_blind;
  was_stopped_ = is_stop;
}

/// Written beside its place and moved there: the collector never sees a half.
void Keeper::write_metrics(const std::string& text) {
  const std::filesystem::path file = metrics_file_;
  std::filesystem::path fresh = file;
  fresh += ".new";
  std::error_code failed;
  {
    std::ofstream out(fresh);
    if (!(out << text).flush()) failed = std::make_error_code(std::errc::io_error);
  }
  // For a collector that runs as another user.
  using std::filesystem::perms;
  if (!failed)
    std::filesystem::permissions(fresh, perms::group_read | perms::others_read,
                                 std::filesystem::perm_options::add, failed);
  if (!failed) std::filesystem::rename(fresh, file, failed);
  say(said_of_metrics_, failed ? "metrics.file: " + metrics_file_ + " cannot be written" : "");
}

/// A sentence once, until there is another one.
void Keeper::say(std::string& said, const std::string& problem) {
  if (problem == said) return;
  if (!problem.empty()) spdlog::warn("{}", problem);
  said = problem;
}

}  // namespace scree
