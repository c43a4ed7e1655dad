#include "keep_up.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "scree/core/nanoseconds.hpp"

namespace scree {

bool KeepUp::update(std::int64_t now_ns, std::uint64_t sweeps, std::uint64_t left_out) {
  constexpr std::int64_t kWindow = 5 * kSecond;
  constexpr double kBusy = 0.05;  // share of the sweeps: less is a host that was busy for a moment
  if (since_ns_ != 0 && now_ns - since_ns_ < kWindow) return false;
  const auto turns = static_cast<double>(sweeps - sweeps_);
  const auto missed = static_cast<double>(left_out - left_out_);
  const double seconds = static_cast<double>(now_ns - since_ns_) * 1e-9;
  const bool is_first = since_ns_ == 0;
  since_ns_ = now_ns;
  sweeps_ = sweeps;
  left_out_ = left_out;
  std::string sentence;
  if (!is_first && missed > kBusy * turns) {
    const bool has_parts = lists_per_turn_ > 1;
    sentence = fmt::format(
        "the detector keeps up with {:.1f} of {:.1f} {} a second: {}", (turns - missed) / seconds,
        turns / seconds, has_parts ? "parts of turns" : "turns",
        has_parts ? "detect.lists_per_turn asks for more lists than this computer can make"
                  : "this computer is too slow for these settings; the drop-in small.toml "
                    "needs half, and `scree bench` measures it");
  }
  if (sentence == sentence_) return false;
  sentence_ = std::move(sentence);
  return true;
}

}  // namespace scree
