#pragma once

#include <cstddef>
#include <cstdint>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "scree/core/result.hpp"
#include "scree/publish/lcm_handle.hpp"

namespace scree {

// Literals: a null character follows each.
inline constexpr std::string_view kObstaclesChannel = "SCREE_OBSTACLES";
inline constexpr std::string_view kGridChannel = "SCREE_GRID";
inline constexpr std::string_view kHealthChannel = "SCREE_HEALTH";

/// A message as LCM sends it.
struct EncodedMessage {
  std::string_view channel;  ///< one of those above
  std::vector<std::uint8_t> bytes;
};

/// Encodes obstacle lists, grids and health. One thread may use it. Grids and lists of up to
/// max_obstacles allocate nothing in a message that has room for longest() bytes.
class MessageEncoder {
public:
  explicit MessageEncoder(std::size_t max_obstacles);

  std::size_t longest() const { return longest_; }
  void encode(const ObstacleList& list, EncodedMessage& encoded);
  void encode(const ObstacleGrid& grid, EncodedMessage& encoded);
  static void encode(const health_t& health, EncodedMessage& encoded);

private:
  obstacle_list_t list_{};
  grid_t grid_{};
  std::size_t longest_;
};

/// Sends messages on LCM. One thread may use it.
class Publisher {
public:
  /// Opens an LCM provider as open_lcm() does; the error says what to do where multicast has no
  /// route.
  static Result<Publisher> open(const std::string& lcm_url);

  /// False when LCM did not take the message. It may block: as long as the network's queue is full,
  /// or as a server of tcpq reads nothing.
  bool send(const EncodedMessage& message);

private:
  explicit Publisher(LcmHandle lcm) : lcm_(std::move(lcm)) {}

  LcmHandle lcm_;
};

}  // namespace scree
