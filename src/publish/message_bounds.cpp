#include "message_bounds.hpp"

#include <cstddef>

namespace scree {
namespace {

constexpr std::size_t kByte = 1, kShort = 2, kInt = 4, kLong = 8, kDouble = 8, kFloat = 4;

/// Goes through a message as lcm-gen lays it out: big-endian, without padding.
class Walk {
public:
  explicit Walk(std::span<const std::uint8_t> message) : rest_(message) { skip(kLong); }  // hash

  void skip(std::size_t bytes, std::size_t times = 1) {
    if (times != 0 && rest_.size() / times < bytes) return stop();
    rest_ = rest_.subspan(bytes * times);
  }
  /// A count of things that follow. @return 0 where it is none
  std::size_t count() {
    const std::size_t begin = rest_.size();
    std::size_t value = 0;
    for (std::size_t i = 0; i < kInt && i < begin; ++i) value = value << 8U | rest_[i];
    skip(kInt);
    if (value > rest_.size()) stop();  // each is a byte at least; negative ones are larger still
    return is_good_ ? value : 0;
  }
  /// The length counts the zero at its end.
  void text() {
    const std::size_t length = count();
    if (length == 0 || rest_[length - 1] != 0) return stop();
    skip(length);
  }
  template <class Item>
  void each(std::size_t count, Item&& item) {
    for (std::size_t i = 0; i < count && is_good_; ++i) item();
  }
  bool is_at_end() const { return is_good_ && rest_.empty(); }

private:
  void stop() {
    is_good_ = false;
    rest_ = {};
  }

  std::span<const std::uint8_t> rest_;
  bool is_good_ = true;
};

void skip_obstacle(Walk& walk) {
  // Before the corners: id, kind, confidence; center, extent, yaw, height, velocity; points,
  // evidence.
  walk.skip(kLong + kByte + kFloat + 10 * kDouble + kInt + kByte);
  const std::size_t corners = walk.count();
  walk.skip(2 * kDouble, corners);
}

void skip_sensor(Walk& walk) {
  walk.skip(kByte);
  walk.text();
  walk.skip(kLong + kDouble + kDouble + kLong + kLong);
  const std::size_t reasons = walk.count();
  walk.each(reasons, [&] { walk.text(); });
  walk.skip(kLong, reasons);
  walk.skip(kByte + kDouble + kDouble);
}

/// A list of things with a name and some bytes behind it.
void skip_named(Walk& walk, std::size_t bytes) {
  walk.each(walk.count(), [&] {
    walk.text();
    walk.skip(bytes);
  });
}

}  // namespace

bool is_obstacle_list(std::span<const std::uint8_t> message) {
  Walk walk(message);
  walk.skip(kLong + 7 * kDouble);
  walk.each(walk.count(), [&] { skip_obstacle(walk); });
  return walk.is_at_end();
}

bool is_grid(std::span<const std::uint8_t> message) {
  Walk walk(message);
  walk.skip(kLong + 10 * kDouble + 2 * kInt);
  const std::size_t cells = walk.count();
  walk.skip(kByte + kShort, cells);
  return walk.is_at_end();
}

bool is_health(std::span<const std::uint8_t> message) {
  constexpr std::size_t kLatency = kLong + 3 * kDouble;
  Walk walk(message);
  walk.skip(kLong);
  walk.text();  // version
  walk.skip(kByte);
  walk.text();  // reason
  walk.skip(kByte);
  walk.each(walk.count(), [&] { walk.text(); });  // setup
  walk.text();                                    // lines_problem
  for (int sensor = 0; sensor < 3; ++sensor) skip_sensor(walk);
  walk.skip(kLong);
  walk.text();  // encoder_bus
  walk.skip(6 * kLong + 2 * kDouble + 3 * kLong + 2 * kLatency);
  skip_named(walk, kLatency);   // stages
  skip_named(walk, 3 * kInt);   // queues
  skip_named(walk, 2 * kLong);  // threads
  walk.skip(kDouble + 8 * kLong);
  return walk.is_at_end();
}

}  // namespace scree
