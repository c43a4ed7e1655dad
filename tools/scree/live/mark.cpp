#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#include "commands.hpp"
#include "scree/config/settings.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

std::set<fs::path> logs_in(const fs::path& folder) {
  std::set<fs::path> logs;
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(folder, unreadable)) {
    if (entry.path().extension() == ".lcm") logs.insert(entry.path());
  }
  return logs;
}

/// Asks the black box of a running screed to be closed, and names the log.
void mark(const std::string& config) {
  const fs::path folder = value_or_fail(load_settings(config)).blackbox.folder;
  if (folder.empty()) throw Failure(config + ": blackbox.folder is empty: screed keeps nothing");
  const std::set<fs::path> before = logs_in(folder);
  const fs::path file = folder / "mark";
  if (!(std::ofstream(file) << "mark\n").flush()) {
    throw Failure("cannot write in " + folder.string() + ": is it there, and may you? (sudo)");
  }
  constexpr std::chrono::milliseconds kPatience{5000}, kPause{50};
  const auto end = std::chrono::steady_clock::now() + kPatience;
  std::error_code none;
  while (fs::exists(file, none)) {
    if (std::chrono::steady_clock::now() > end) {
      fs::remove(file, none);
      throw Failure("nobody took the mark: does screed run, with the same blackbox.folder?");
    }
    std::this_thread::sleep_for(kPause);
  }
  for (const fs::path& log : logs_in(folder)) {
    if (before.contains(log)) continue;
    fmt::print("{}\n", log.string());
    return;
  }
  throw Failure("the black box holds nothing yet");
}

}  // namespace

void add_mark(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("mark", "Close screed's black box now, and print the name of the log");
  auto config = std::make_shared<std::string>(kConfigOfRobot);
  command->add_option("--config", *config, "configuration of screed")
      ->type_name("FILE")
      ->capture_default_str();
  command->callback([config] { mark(*config); });
}

}  // namespace scree::cli
