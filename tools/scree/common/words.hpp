#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "common/usage_error.hpp"

namespace scree::cli {

template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& words) {
  std::vector<std::string> names;
  for (const auto& [word, meaning] : words) names.push_back(word);
  return names;
}

/// An option whose value is one of some words. Help and errors list them. (CLI11's own transformers
/// print the numbers behind the words, too.)
template <class Value>
CLI::Option* add_words(CLI::App& command, const std::string& name, Value& value,
                       const std::map<std::string, Value>& words, const std::string& help) {
  const auto take = [&value, words](const std::string& word) { value = words.at(word); };
  return command.add_option_function<std::string>(name, take, help)->check(one_of(names_of(words)));
}

}  // namespace scree::cli
