#pragma once

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "scree/core/result.hpp"

namespace scree::cli {

/// Where the package puts the robot's configuration.
inline constexpr const char* kConfigOfRobot = "/etc/scree/scree.toml";

/// Thrown by a subcommand whose work failed: one sentence for stderr, exit code 1.
/// For wrong usage that CLI11 cannot see by itself throw CLI::ValidationError: exit code 2.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The value; throws Failure where there is none.
template <class T>
T value_or_fail(Result<T> result) {
  if (!result) throw Failure(result.error().message);
  return std::move(*result);
}
/// Throws Failure where something was not done.
inline void require(const Result<void>& done) {
  if (!done) throw Failure(done.error().message);
}

// One file a subcommand; each adds itself with its options and its callback, and is called in
// main.cpp. Only the asked-for result goes to stdout.

void add_info(CLI::App& app);
void add_decode(CLI::App& app);
void add_bench(CLI::App& app);
void add_detect(CLI::App& app);
void add_simulate(CLI::App& app);
void add_train(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_study(CLI::App& app);
void add_picture(CLI::App& app);
void add_report(CLI::App& app);
void add_replay(CLI::App& app);
void add_slice(CLI::App& app);
void add_record(CLI::App& app);
void add_watch(CLI::App& app);
void add_view(CLI::App& app);
void add_status(CLI::App& app);
void add_mark(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_doctor(CLI::App& app);
void add_top(CLI::App& app);
void add_config(CLI::App& app);

}  // namespace scree::cli
