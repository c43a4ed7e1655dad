#include "commands.hpp"

namespace scree::cli {

void add_info(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "What a capture holds");
  command->callback([] { throw Failure("cannot read captures yet"); });
}

}  // namespace scree::cli
