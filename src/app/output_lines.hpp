#pragma once

#include <string>

#include "scree/app/robot_lines.hpp"
#include "scree/config/settings.hpp"
#include "scree/core/obstacle.hpp"
#include "scree/publish/stop_line.hpp"

namespace scree {

/// One output. Says in the log when it cannot be set and when it can again, once.
class OutputLine {
public:
  /// @param name for people; without `set` there is no such line
  OutputLine(std::string name, RobotLines::Set set);

  /// Sets the level. It is called again and again, for a chip that was unplugged has forgotten it.
  void set(bool is_on);
  /// One sentence while it cannot be set, else empty.
  const std::string& problem() const { return problem_; }

private:
  std::string name_;
  RobotLines::Set set_;
  std::string problem_;
};

/// Drives the stop line, as StopLine decides, and the heartbeat. Times are of the steady clock. One
/// thread may use it.
class OutputLines {
public:
  OutputLines(const StopSettings& zone, const RobotLines& lines);

  void set_zone(const StopSettings& zone) { decision_.set_zone(zone); }
  void update(const ObstacleList& list, std::int64_t now_ns);
  void set_blind(bool is_blind, std::int64_t now_ns);
  /// Changes the level of the heartbeat.
  void toggle_heartbeat();

  bool is_stopped(std::int64_t now_ns) const { return decision_.is_on(now_ns); }
  /// The problem of the stop line, else that of the heartbeat; see OutputLine.
  const std::string& problem() const;

private:
  StopLine decision_;
  OutputLine stop_, heartbeat_;
  bool is_heartbeat_on_ = false;
};

}  // namespace scree
