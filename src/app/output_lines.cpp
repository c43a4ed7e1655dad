#include "output_lines.hpp"

#include <spdlog/spdlog.h>

#include <utility>

namespace scree {

OutputLine::OutputLine(std::string name, RobotLines::Set set)
    : name_(std::move(name)), set_(std::move(set)) {}

void OutputLine::set(bool is_on) {
  if (!set_) return;
  if (set_(is_on)) {
    if (problem_.empty()) return;
    spdlog::info("the {} line can be set again", name_);
    problem_.clear();
  } else if (problem_.empty()) {
    problem_ = "the " + name_ + " line cannot be set: is its chip still there (`gpiodetect`)?";
    spdlog::error(problem_);
  }
}

OutputLines::OutputLines(const StopSettings& zone, const RobotLines& lines)
    : decision_(zone), stop_("stop", lines.stop), heartbeat_("heartbeat", lines.heartbeat) {}

void OutputLines::update(const ObstacleList& list, std::int64_t now_ns) {
  decision_.update(list, now_ns);
  stop_.set(decision_.is_on(now_ns));
}

void OutputLines::set_blind(bool is_blind, std::int64_t now_ns) {
  decision_.set_blind(is_blind, now_ns);
  stop_.set(decision_.is_on(now_ns));
}

void OutputLines::toggle_heartbeat() {
  is_heartbeat_on_ = !is_heartbeat_on_;
  heartbeat_.set(is_heartbeat_on_);
}

const std::string& OutputLines::problem() const {
  return stop_.problem().empty() ? heartbeat_.problem() : stop_.problem();
}

}  // namespace scree
