#pragma once

#include <cstdint>
#include <functional>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <span>
#include <string_view>

namespace scree {

using OnList = std::function<void(const obstacle_list_t&)>;
using OnHealth = std::function<void(const health_t&)>;
using OnGrid = std::function<void(const grid_t&)>;

/// Decodes what a Publisher sends. Whatever bytes come are safe: each message is checked before it
/// is decoded.
class MessageDecoder {
public:
  /// @param on_grid without it no grid is decoded
  MessageDecoder(OnList on_list, OnHealth on_health, OnGrid on_grid = {});

  /// Whether it is of a channel that is listened to.
  bool take(std::string_view channel, std::span<const std::uint8_t> data);

  /// Messages that were malformed, or of another version of Scree.
  std::uint64_t refused() const { return refused_; }

private:
  template <class Message, class Handler>
  void decode(std::span<const std::uint8_t> data, bool is_sound, const Handler& handler);

  OnList on_list_;
  OnHealth on_health_;
  OnGrid on_grid_;
  std::uint64_t refused_ = 0;
};

}  // namespace scree
