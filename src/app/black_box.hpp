#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scree/config/settings.hpp"
#include "scree/core/descriptor.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// Keeps what was published lately in a ring of files, and closes it into one LCM log when
/// something happens. The ring is in `ring` of its folder, a part a file, so what a crash leaves is
/// there at the next start. Times are nanoseconds since the UNIX epoch, on the host's clock. One
/// thread may use it.
class BlackBox {
public:
  static constexpr std::string_view kMarkFile = "mark";  ///< what `scree mark` writes
  static constexpr int kParts = 6;                       ///< of the ring, at least

  /// Makes the folder. What an earlier screed has left in the ring is closed as "crash".
  static Result<BlackBox> open(const BlackBoxSettings& settings, std::int64_t now_ns);

  /// Writes a message into the ring; what is too old, or too much, falls out of it.
  void take(std::string_view channel, std::int64_t now_ns, std::span<const std::uint8_t> message);
  /// A reason that comes again and again is closed only when half of the time that the ring keeps
  /// has passed since; until then what belongs to it stays in the ring.
  void close_for_state(std::string_view reason, std::int64_t now_ns);
  /// Closes the ring into FOLDER/TIME_REASON.lcm, and begins anew. Of an empty ring nothing.
  void close(std::string_view reason, std::int64_t now_ns);
  /// Closes it where `scree mark` asks for it.
  void look_for_mark(std::int64_t now_ns);

  /// One sentence while nothing can be written, else empty.
  const std::string& problem() const { return problem_; }

private:
  struct Part {
    std::filesystem::path file;
    std::int64_t begin_ns = 0;
    std::uint64_t bytes = 0;
  };

  explicit BlackBox(const BlackBoxSettings& settings);
  Result<void> close_leftovers(std::int64_t now_ns);
  void begin_part(std::int64_t now_ns);
  void let_fall_out(std::int64_t now_ns);
  void forget_oldest_logs();
  void fail_with(const std::string& what);

  BlackBoxSettings settings_;
  Descriptor lock_;  // of the ring, as long as this one writes
  std::filesystem::path folder_, ring_;
  std::deque<Part> parts_;  // the last one is being written
  std::ofstream file_;
  std::vector<std::uint8_t> event_;
  std::int64_t events_ = 0;
  std::uint64_t next_part_ = 0;
  std::optional<std::int64_t> closed_ns_;  // for a state
  std::string problem_;
};

}  // namespace scree
