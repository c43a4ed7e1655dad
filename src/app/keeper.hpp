#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "black_box.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"
#include "spsc_pool.hpp"

namespace scree {

/// A message on its way into files.
struct KeptMessage {
  explicit KeptMessage(std::size_t longest) { bytes.reserve(longest); }
  std::string_view channel;  ///< of a literal
  std::int64_t time_ns = 0;  ///< since the UNIX epoch
  std::vector<std::uint8_t> bytes;
};

/// Writes the black box and the metrics, in a thread of its own: a slow disk delays nobody. What it
/// has no room for is dropped, and the log says so.
class Keeper {
public:
  /// Nothing where the settings ask for nothing. The error says what cannot be written.
  static Result<std::unique_ptr<Keeper>> start(const Settings& settings);
  ~Keeper();
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

  /// The publisher's thread: keeps what was published.
  void put(std::string_view channel, std::span<const std::uint8_t> message);
  /// The lidar's thread: the same of a raw packet. Allocates nothing.
  void put_packet(std::span<const std::uint8_t> datagram);

private:
  using Pool = SpscPool<KeptMessage>;

  Keeper(std::optional<BlackBox> box, std::string metrics_file, bool keeps_packets);
  static bool fill(Pool& pool, std::string_view channel, std::span<const std::uint8_t> bytes);
  void run();
  void drain(Pool& pool);
  void take(const KeptMessage& message);
  void take_health(const KeptMessage& message);
  void write_metrics(const std::string& text);
  static void say(std::string& said, const std::string& problem);

  std::optional<BlackBox> box_;
  std::string metrics_file_;
  bool keeps_packets_;
  Pool messages_, packets_;
  std::atomic<std::uint64_t> dropped_{0};
  std::uint64_t dropped_said_ = 0;
  bool was_blind_ = true, was_stopped_ = true;
  std::string said_of_box_, said_of_metrics_;
  std::atomic<bool> is_stopped_{false};
  std::thread thread_;
};

}  // namespace scree
