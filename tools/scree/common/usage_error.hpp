#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scree::cli {

/// For a command or an option that is not there: one sentence that names the nearest. Empty where
/// the error is another one.
std::string unknown_word(const CLI::App& app, const CLI::ParseError& error, int argc,
                         const char* const* argv);

}  // namespace scree::cli
