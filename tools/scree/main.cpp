#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>

#include "commands.hpp"
#include "common/usage_error.hpp"
#include "scree/core/lower_case.hpp"

namespace {

enum ExitCode : int { kDone = 0, kFailed = 1, kUsage = 2 };

void add_all(CLI::App& app) {
  scree::cli::add_info(app);
  scree::cli::add_decode(app);
  scree::cli::add_detect(app);
  scree::cli::add_simulate(app);
  scree::cli::add_train(app);
  scree::cli::add_evaluate(app);
  scree::cli::add_study(app);
  scree::cli::add_picture(app);
  scree::cli::add_report(app);
  scree::cli::add_replay(app);
  scree::cli::add_slice(app);
  scree::cli::add_record(app);
  scree::cli::add_watch(app);
  scree::cli::add_view(app);
  scree::cli::add_status(app);
  scree::cli::add_mark(app);
  scree::cli::add_calibrate(app);
  scree::cli::add_doctor(app);
  scree::cli::add_top(app);
  scree::cli::add_bench(app);
  scree::cli::add_config(app);
}

/// What no number in a command line can be: not even the ranges of options refuse it.
bool is_nan(std::string_view word) {
  if (const auto equals = word.find('='); equals != std::string_view::npos) {
    word.remove_prefix(equals + 1);
  }
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  return scree::lower_case(word) == "nan";
}

/// A configuration may have many mistakes: a line each.
int failed(const std::string& reason) {
  std::istringstream lines(reason);
  for (std::string line; std::getline(lines, line);) {
    std::fprintf(stderr, "scree: %s\n", line.c_str());
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  // `scree help detect` asks for what `scree detect --help` does.
  char asks_for_help[] = "--help";
  if (argc > 1 && argc <= 3 && std::string_view(argv[1]) == "help") {
    if (argc == 3) argv[1] = argv[2];
    argv[argc == 3 ? 2 : 1] = asks_for_help;
  }
  CLI::App app("Obstacle detection for robots on rough ground");
  app.name("scree");
  app.set_version_flag("--version", SCREE_VERSION);
  app.require_subcommand(1);
  add_all(app);
  if (const auto* const nan = std::find_if(argv + 1, argv + argc, is_nan); nan != argv + argc) {
    const bool is_option = (*nan)[0] == '-' || (nan > argv + 1 && nan[-1][0] == '-');
    std::fprintf(stderr, "scree: %s is no number%s\n", *nan,
                 is_option ? "" : " (a file of that name is ./nan)");
    return kUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const auto unknown = scree::cli::unknown_word(app, error, argc, argv); !unknown.empty()) {
      std::fprintf(stderr, "scree: %s\n", unknown.c_str());
      return kUsage;
    }
    if (app.exit(error) != 0) return kUsage;
  } catch (const std::bad_alloc&) {
    return failed("there is not enough memory (`ulimit -v`, `free -m`)");
  } catch (const std::exception& error) {
    return failed(error.what());
  }
  // A full disk or a closed pipe shows itself only when the last bytes are written out.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fprintf(stderr, "scree: cannot write to standard output\n");
    return kFailed;
  }
  return kDone;
}
