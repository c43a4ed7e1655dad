#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <scree/grid_t.hpp>
#include <scree/health_t.hpp>
#include <scree/obstacle_list_t.hpp>
#include <span>
#include <string>
#include <vector>

#include "scree/core/obstacle.hpp"
#include "scree/core/obstacle_grid.hpp"
#include "scree/core/result.hpp"

namespace scree {

inline constexpr const char* kObstaclesChannel = "SCREE_OBSTACLES";
inline constexpr const char* kGridChannel = "SCREE_GRID";
inline constexpr const char* kHealthChannel = "SCREE_HEALTH";

/// Sends obstacle lists, grids and health on LCM. One thread may use it. Its buffers are sized when
/// it is made: sending a grid or a list of up to max_obstacles allocates nothing.
class Publisher {
public:
  /// Opens an LCM provider; the error says what to do where multicast has no route.
  static Result<Publisher> open(const std::string& lcm_url, std::size_t max_obstacles);

  /// False when LCM did not take the message.
  bool publish(const ObstacleList& list);
  bool publish(const ObstacleGrid& grid);
  bool publish(const health_t& health);

  /// The message that was published last, as it was sent. Valid until the next one.
  std::span<const std::uint8_t> last() const { return std::span(encoded_).first(last_size_); }

private:
  struct Destroy {
    void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
  };

  Publisher(lcm_t* lcm, std::size_t max_obstacles);
  template <class Message>
  bool send(const char* channel, const Message& message);

  std::unique_ptr<lcm_t, Destroy> lcm_;
  obstacle_list_t list_{};
  grid_t grid_{};
  std::vector<std::uint8_t> encoded_;
  std::size_t last_size_ = 0;
};

}  // namespace scree
