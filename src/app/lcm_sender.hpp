#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "scree/publish/publisher.hpp"
#include "spsc_pool.hpp"

namespace scree {

class Keeper;

/// Hands messages to LCM in a thread of its own, because LCM may block (see Publisher::send) and
/// whoever drives the stop line must not. Full means: the newest message is dropped and counted.
class LcmSender {
public:
  /// What has become of the messages since the start.
  struct Counts {
    std::uint64_t lists = 0;          ///< taken by LCM
    std::uint64_t failed = 0;         ///< lists and grids that LCM did not take, or dropped
    std::uint64_t health_failed = 0;  ///< the same of health
    std::int64_t last_list_ns = 0;    ///< of the data of the newest list that was taken, 0: none
  };

  /// Starts the thread. It keeps the object alive, so that one that hangs can be left behind.
  /// @param keeper gets every message, also those that are dropped; null: nobody does
  static std::shared_ptr<LcmSender> start(Publisher publisher, std::size_t max_obstacles,
                                          Keeper* keeper = nullptr);

  // For one thread. Nothing blocks.

  /// @param data_ns the time of the list's data on the steady clock
  void put(const ObstacleList& list, std::int64_t data_ns);
  void put(const ObstacleGrid& grid);
  /// False when it was dropped.
  bool put(const health_t& health);
  Counts counts() const;
  /// Lets the thread send what waits and end; false when it has not by then.
  bool finish(std::chrono::milliseconds longest);

private:
  struct Outgoing {
    EncodedMessage message;
    std::int64_t data_ns = 0;  // of a list
  };

  LcmSender(Publisher publisher, std::size_t max_obstacles, Keeper* keeper);
  void run();
  void send(const Outgoing& outgoing);
  template <class Message>
  bool put(const Message& message, std::int64_t data_ns, std::atomic<std::uint64_t>& failed);

  Publisher publisher_;
  MessageEncoder encoder_;
  Keeper* keeper_;
  EncodedMessage dropped_;  // for the keeper
  SpscPool<Outgoing> waiting_;
  Event done_;
  std::atomic<bool> is_stopped_{false};
  std::atomic<std::uint64_t> lists_{0}, failed_{0}, health_failed_{0};
  std::atomic<std::int64_t> last_list_ns_{0};
};

}  // namespace scree
