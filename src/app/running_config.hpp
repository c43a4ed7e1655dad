#pragma once

#include <filesystem>

#include "scree/config/settings.hpp"
#include "scree/core/result.hpp"

namespace scree {

/// The configuration file of a running daemon, and what the daemon has taken from it.
class RunningConfig {
public:
  /// The one check for a start, a reload and --check-config: everything that the daemon would
  /// refuse as far as files tell. The error names file, line and key.
  static Result<RunningConfig> read(const std::filesystem::path& file);

  /// With what a DBC file says.
  const Settings& settings() const { return settings_; }

  /// Takes over what can change while the daemon runs; true when something did. What cannot, and
  /// why a bad file is refused, is said in the log, and the old settings stay.
  bool reread();

private:
  RunningConfig(std::filesystem::path file, const Settings& written, const Settings& settings);

  std::filesystem::path file_;
  Settings written_;  // without what a DBC file says, to compare with the next
  Settings settings_;
};

}  // namespace scree
