#pragma once

#include <cstdint>
#include <cstdlib>

#include "scree/core/nanoseconds.hpp"

namespace scree::velodyne {

/// Takes the packets of one sender where several send to the same port: mixed, those of two sensors
/// make no sweep. It is the first one that is heard, until it has been silent for a second.
class OneSender {
public:
  /// @param sender any number but 0 that tells the senders apart, as an IPv4 address; of 0 (not
  ///        known) every packet is taken
  bool takes(std::uint32_t sender, std::int64_t arrival_ns) {
    if (sender == 0) return true;
    const bool is_silent = std::abs(arrival_ns - heard_ns_) > kSecond;
    if (taken_ == 0 || sender == taken_ || is_silent) {
      taken_ = sender;
      heard_ns_ = arrival_ns;
      return true;
    }
    other_ = sender;
    ++left_out_;
    return false;
  }
  std::uint32_t taken() const { return taken_; }
  /// The last one that was left out; 0: none was.
  std::uint32_t other() const { return other_; }
  std::uint64_t left_out() const { return left_out_; }

private:
  std::uint32_t taken_ = 0, other_ = 0;
  std::int64_t heard_ns_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace scree::velodyne
