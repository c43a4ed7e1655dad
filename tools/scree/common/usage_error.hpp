#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace scree::cli {

/// For a command or an option that is not there: one sentence that names the nearest. Empty where
/// the error is another one.
std::string unknown_word(const CLI::App& app, const CLI::ParseError& error, int argc,
                         const char* const* argv);

/// Accepts these words. Help and errors list them, and an error names the nearest.
CLI::Validator one_of(const std::vector<std::string>& words);

}  // namespace scree::cli
