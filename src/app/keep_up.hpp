#pragma once

#include <cstdint>
#include <string>

namespace scree {

/// Says when the detector is too slow for the lidar, and how much: sweeps, or parts of them, are
/// left out then. It looks back over windows of 5 s.
class KeepUp {
public:
  explicit KeepUp(int lists_per_turn) : lists_per_turn_(lists_per_turn) {}

  /// @param sweeps of the lidar so far, and parts of them that should have had a list
  /// @param left_out of them: found the detector busy
  /// @return whether the sentence changed
  bool update(std::int64_t now_ns, std::uint64_t sweeps, std::uint64_t left_out);
  /// Empty while it keeps up.
  const std::string& sentence() const { return sentence_; }

private:
  int lists_per_turn_;
  std::int64_t since_ns_ = 0;
  std::uint64_t sweeps_ = 0, left_out_ = 0;  // then
  std::string sentence_;
};

}  // namespace scree
