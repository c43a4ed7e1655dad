#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"
#include "scree/publish/lcm_handle.hpp"
#include "scree/publish/message_decoder.hpp"

namespace scree {

class LcmDatagrams;

/// Receives what a Publisher sends. One thread may use it. Whatever bytes come are safe: multicast
/// is read here and not by liblcm, and each message is checked before it is decoded.
class Subscriber {
public:
  /// Called from handle(); must not throw, because LCM, which is C, may lie between.
  using OnList = scree::OnList;
  using OnHealth = scree::OnHealth;
  using OnGrid = scree::OnGrid;

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
  Subscriber(OnList on_list, OnHealth on_health, OnGrid on_grid);
  bool subscribe();
  bool handle_datagrams(int milliseconds);

  Descriptor socket_;  // of the multicast group, or ...
  LcmHandle lcm_;      // ... any other provider
  std::unique_ptr<LcmDatagrams> datagrams_;
  std::vector<std::uint8_t> buffer_;
  MessageDecoder decoder_;
};

}  // namespace scree
