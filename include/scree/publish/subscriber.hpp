#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <string>
#include <vector>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree {

class LcmDatagrams;
struct LcmMessage;

/// Receives what a Publisher sends. One thread may use it. Whatever bytes come are safe: multicast
/// is read here and not by liblcm, and each message is checked before it is decoded.
class Subscriber {
public:
  /// Called from handle(); must not throw, because LCM, which is C, may lie between.
  using OnList = std::function<void(const obstacle_list_t&)>;
  using OnHealth = std::function<void(const health_t&)>;
  using OnGrid = std::function<void(const grid_t&)>;

  /// Listens from here on; the error says what to do where multicast has no route, or nobody
  /// answers at the other end of a connection.
  /// @param on_grid without it no grid is received
  static Result<std::unique_ptr<Subscriber>> open(const std::string& lcm_url, OnList on_list,
                                                  OnHealth on_health, OnGrid on_grid = {});
  ~Subscriber();

  /// Waits for one message and has it handled. It waits at most so long, or until a signal comes.
  /// False when LCM failed.
  bool handle(int milliseconds);

  /// Datagrams and messages that were malformed, or of another version of Scree.
  std::uint64_t refused() const;

private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  Subscriber(OnList on_list, OnHealth on_health, OnGrid on_grid);
  bool subscribe(const std::string& lcm_url);
  bool handle_datagrams(int milliseconds);
  bool take(const LcmMessage& message);
  template <class Message, class Handler>
  void decode(const LcmMessage& encoded, bool is_sound, const Handler& handler);

  Descriptor socket_;                    // of the multicast group, or ...
  std::unique_ptr<lcm_t, Destroy> lcm_;  // ... any other provider
  std::unique_ptr<LcmDatagrams> datagrams_;
  std::vector<std::uint8_t> buffer_;
  OnList on_list_;
  OnHealth on_health_;
  OnGrid on_grid_;
  std::uint64_t refused_ = 0;
};

}  // namespace scree
