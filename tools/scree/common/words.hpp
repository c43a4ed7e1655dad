#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace scree::cli {

/// An option whose value is one of some words. Help and errors list them. (CLI11's own transformers
/// print the numbers behind the words, too.)
template <class Value>
CLI::Option* add_words(CLI::App& command, const std::string& name, Value& value,
                       const std::map<std::string, Value>& words, const std::string& help) {
  const auto take = [&value, words](const std::string& word) { value = words.at(word); };
  return command.add_option_function<std::string>(name, take, help)->check(CLI::IsMember(words));
}

}  // namespace scree::cli
