#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace scree::cli {

/// Which LCM a command listens to.
struct LcmOptions {
  std::string config, url;

  void add_to(CLI::App& command);
  /// As given, or of the configuration given, or the default one. Throws Failure where the
  /// configuration is wrong.
  std::string url_of() const;
};

}  // namespace scree::cli
