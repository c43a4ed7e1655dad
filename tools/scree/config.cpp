#include <spdlog/fmt/fmt.h>

#include <memory>
#include <string>

#include "commands.hpp"
#include "scree/config/configuration.hpp"

namespace scree::cli {
namespace {

struct ConfigOptions {
  std::string file = kConfigOfRobot;
  bool defaults = false, all = false, only_set = false;
};

void print_config(const ConfigOptions& options) {
  const Configuration configuration =
      options.defaults ? Configuration() : value_or_fail(read_configuration(options.file));
  const Shown shown = options.all ? Shown::all : options.only_set ? Shown::set : Shown::owners;
  fmt::print("{}", effective_toml(configuration, shown));
}

}  // namespace

void add_config(CLI::App& app) {
  auto options = std::make_shared<ConfigOptions>();
  CLI::App& config = *app.add_subcommand(
      "config", "The configuration that takes effect, and where each value comes from, as TOML");
  CLI::Option* const file =
      config.add_option("--config", options->file, "configuration; drop-ins lie in its folder *.d")
          ->type_name("FILE")
          ->capture_default_str();
  CLI::Option* const all = config.add_flag(
      "--all", options->all,
      "every key; without it those that a robot's owner sets, and what a file sets");
  config.add_flag("--set", options->only_set, "only what a file sets")->excludes(all);
  config.add_flag("--defaults", options->defaults, "without any file")->excludes(file);
  config.callback([options] { print_config(*options); });
}

}  // namespace scree::cli
