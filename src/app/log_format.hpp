#pragma once

#include <memory>
#include <string>

#include "log_writer.hpp"

namespace scree {

/// Sends the log to standard error: with a time stamp for a terminal or a file, with a level that
/// `journalctl -p` knows for the journal.
class Log {
public:
  Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  /// What waits is written, unless nobody reads it for half a second.
  ~Log();

  /// Why this program ends; each line is a line of its own.
  void failed(const std::string& reason);

private:
  std::shared_ptr<LogWriter> writer_;
};

}  // namespace scree
