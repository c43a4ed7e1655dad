#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "common/fresh_file.hpp"
#include "common/outputs.hpp"
#include "read/lidar_capture.hpp"
#include "report/gather.hpp"
#include "report/page.hpp"
#include "scree/capture/pcd.hpp"

namespace scree::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  fs::path input, config, grid, truth, out = "report.html";
  bool wants_truth = false;
  Outputs outputs;
};

/// As given, else the capture's own; nothing where none was asked for.
fs::path truth_file(const ReportOptions& options) {
  if (!options.wants_truth || !options.truth.empty()) return options.truth;
  fs::path own = options.input / "truth.json";
  if (!fs::exists(own)) {
    throw Failure(
        fmt::format("{} has no truth.json: name the file, --truth FILE", options.input.string()));
  }
  return own;
}

void report(const ReportOptions& options) {
  options.outputs.require_free({options.out},
                               {options.input, options.config, options.grid, options.truth});
  if (is_pcd(options.input)) {
    throw Failure(options.input.string() + " is one cloud and no drive: `scree picture` draws it");
  }
  const fs::path truth = truth_file(options);
  ReportData data;
  data.title = fs::absolute(options.input).lexically_normal().filename().string();
  if (data.title.empty())
    data.title = fs::absolute(options.input).parent_path().filename().string();
  if (holds_lists(options.input)) {
    data.source = "lists";
    if (!options.config.empty()) data.stop = capture_settings(options.input, options.config).stop;
    gather_lists(options.input, options.grid, data);
  } else {
    if (!options.grid.empty())
      throw Failure("--grid belongs to lists: a capture's grids are made anew");
    data.source = "capture";
    gather_capture(options.input, options.config, data);
  }
  if (data.lists().empty())
    throw Failure(options.input.string() + ": nothing was looked at, there is no list");
  if (!truth.empty()) data.compare_with(value_or_fail(read_truth(truth)));
  const std::string page = report_page(data.title + " - Scree", data.pack());
  write_whole(options.out, page);
  fmt::print("{}: {} lists, {:.1f} MB\n", options.out.string(), data.lists().size(),
             static_cast<double>(page.size()) * 1e-6);
}

}  // namespace

void add_report(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("report", "A drive as one HTML page: map, obstacles, health, truth");
  auto options = std::make_shared<ReportOptions>();
  command
      ->add_option("INPUT", options->input,
                   "capture, or lists: JSON lines of `scree detect` or `scree watch`, LCM log")
      ->required()
      ->check(CLI::ExistingPath);
  CLI::Option* const truth = command->add_option(
      "--truth", options->truth, "compare with it; without FILE: the capture's truth.json");
  truth->expected(0, 1)->type_name("FILE");
  command
      ->add_option("--grid", options->grid, "grids that belong to lists, of `scree detect --grid`")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  command->add_option("--config", options->config, "configuration; default: the capture's own")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  command->add_option("--out", options->out, "page to write [report.html]")->type_name("FILE");
  options->outputs.add_to(*command);
  command->callback([options, truth] {
    options->wants_truth = truth->count() > 0;
    report(*options);
  });
}

}  // namespace scree::cli
