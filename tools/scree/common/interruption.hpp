#pragma once

namespace scree::cli {

/// From here on SIGINT and SIGTERM do not end the program: it ends its work when it sees them.
void stop_on_signals();
bool is_interrupted();

}  // namespace scree::cli
