#include "common/usage_error.hpp"

#include <spdlog/fmt/fmt.h>

#include <string_view>
#include <vector>

#include "scree/config/near_names.hpp"

namespace scree::cli {
namespace {

/// The end of a sentence on a word that is not known.
std::string or_nearest(std::string_view word, const std::vector<std::string>& names,
                       std::string_view all) {
  const std::string nearest = nearest_name(word, {names.begin(), names.end()});
  return nearest.empty() ? fmt::format(": {}", all)
                         : fmt::format("; did you mean \"{}\"?", nearest);
}

std::string unknown_command(const CLI::App& app, std::string_view word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("there is no command \"{}\"{}", word,
                     or_nearest(word, names, "`scree --help` lists them"));
}

std::string unknown_option(const CLI::App& command, std::string_view word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string_view name = word.substr(0, word.find('='));
  const std::string all = fmt::format("`scree {} --help` lists them", command.get_name());
  return fmt::format("{} has no option \"{}\"{}", command.get_name(), name,
                     or_nearest(name, names, all));
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
  CLI::Validator validator = CLI::IsMember(words);
  validator.operation([is_member = validator, words](std::string& word) {
    const std::string refused = is_member(word);
    if (refused.empty()) return refused;
    const std::string nearest = nearest_name(word, {words.begin(), words.end()});
    return nearest.empty() ? refused : fmt::format("{}; did you mean {}?", refused, nearest);
  });
  return validator;
}

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
