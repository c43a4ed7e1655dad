#include "commands.hpp"

namespace scree::cli {

void add_decode(CLI::App& app) {
  CLI::App* command = app.add_subcommand("decode", "What the decoders read, as CSV");
  command->callback([] { throw Failure("cannot read captures yet"); });
}

}  // namespace scree::cli
