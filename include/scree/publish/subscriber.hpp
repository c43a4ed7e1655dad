#pragma once

#include <lcm/lcm.h>

#include <functional>
#include <memory>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <string>

#include "scree/core/result.hpp"

namespace scree {

/// Receives what a Publisher sends. One thread may use it.
class Subscriber {
public:
  /// Called from handle(); must not throw, because LCM, which is C, lies between.
  using OnList = std::function<void(const obstacle_list_t&)>;
  using OnHealth = std::function<void(const health_t&)>;
  using OnGrid = std::function<void(const grid_t&)>;

  /// Listens from here on; the error says what to do where multicast has no route.
  /// @param on_grid without it no grid is received
  static Result<std::unique_ptr<Subscriber>> open(const std::string& lcm_url, OnList on_list,
                                                  OnHealth on_health, OnGrid on_grid = {});

  /// Waits for one message and has it handled. It waits at most so long, or until a signal comes.
  /// False when LCM failed.
  bool handle(int milliseconds);

private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };
  Subscriber(lcm_t* lcm, OnList on_list, OnHealth on_health, OnGrid on_grid);
  template <class Message, class Handler, Handler Subscriber::*handler>
  static void take(const lcm_recv_buf_t* buffer, const char* channel, void* subscriber);

  std::unique_ptr<lcm_t, Destroy> lcm_;
  OnList on_list_;
  OnHealth on_health_;
  OnGrid on_grid_;
};

}  // namespace scree
