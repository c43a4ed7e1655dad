#pragma once

namespace scree {

/// Sends the log to standard error: with a time stamp for a terminal or a file, with a level that
/// `journalctl -p` knows for the journal.
void set_up_log();

}  // namespace scree
