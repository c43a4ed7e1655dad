#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace scree {

/// Passes the newest value of one thread to one other, whole and without waiting. One of the three
/// copies belongs to the writer, one to the reader, and the third changes hands.
template <class Value>
class TripleBuffer {
public:
  /// Writer.
  void put(const Value& value) {
    copies_[writers_] = value;
    const std::uint8_t given = static_cast<std::uint8_t>(writers_ | kIsNew);
    writers_ = shared_.exchange(given, std::memory_order_acq_rel) & kIndex;
  }
  /// Reader: the newest value put, a default one before the first.
  const Value& get() {
    if ((shared_.load(std::memory_order_relaxed) & kIsNew) != 0) {
      readers_ = shared_.exchange(readers_, std::memory_order_acq_rel) & kIndex;
    }
    return copies_[readers_];
  }

private:
  static constexpr std::uint8_t kIndex = 3, kIsNew = 4;
  std::array<Value, 3> copies_{};
  std::uint8_t writers_ = 0, readers_ = 1;
  std::atomic<std::uint8_t> shared_{2};
};

}  // namespace scree
