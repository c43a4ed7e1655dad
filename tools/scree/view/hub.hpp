#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

namespace scree::cli {

/// The latest event of each kind, from one thread to any number of viewers. A viewer that is slow
/// misses what a newer one took the place of.
class Hub {
public:
  static constexpr std::array<std::string_view, 3> kKinds = {"list", "grid", "health"};
  enum class Kind : std::uint8_t { list, grid, health };  ///< in the order of kKinds

  /// How far a viewer is.
  using Seen = std::array<std::uint64_t, kKinds.size()>;

  void say(Kind kind, std::string_view json);
  /// Waits until there is something that this viewer has not seen, and takes it as server-sent
  /// events. Empty when nothing came in that time, or the hub was closed.
  std::string next(Seen& seen, std::chrono::milliseconds patience);
  /// Nobody waits any longer.
  void close();
  bool is_closed() const;

private:
  struct Event {
    std::uint64_t number = 0;  // 0: none yet
    std::string json;
  };
  bool has_news(const Seen& seen) const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Event, kKinds.size()> events_;
  bool is_closed_ = false;
};

}  // namespace scree::cli
