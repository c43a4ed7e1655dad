#include "common/usage_error.hpp"

#include <spdlog/fmt/fmt.h>

#include <string_view>
#include <vector>

#include "scree/config/near_names.hpp"

namespace scree::cli {
namespace {

std::string unknown_command(const CLI::App& app, std::string_view word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("there is no command \"{}\"; did you mean \"{}\"?", word,
                     near_names(word, {names.begin(), names.end()}, 1));
}

std::string unknown_option(const CLI::App& command, std::string_view word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string_view name = word.substr(0, word.find('='));
  return fmt::format("{} has no option \"{}\"; did you mean \"{}\"?", command.get_name(), name,
                     near_names(name, {names.begin(), names.end()}, 1));
}

}  // namespace

std::string unknown_word(const CLI::App& app, const CLI::ParseError& error, int argc,
                         const char* const* argv) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return "";
  const std::string_view first = argc > 1 ? argv[1] : "";
  if (!first.empty() && !first.starts_with('-') && app.get_subcommands().empty()) {
    return unknown_command(app, first);
  }
  const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  if (!is_extra && !app.get_subcommands().empty()) return "";
  const CLI::App& command = app.get_subcommands().empty() ? app : *app.get_subcommands().front();
  for (const std::string& word : command.remaining()) {
    if (word.starts_with("--")) return unknown_option(command, word);
  }
  return "";
}

}  // namespace scree::cli
