#include <cstdio>
#include <memory>

#include "commands.hpp"
#include "detection/detections.hpp"
#include "detection/score_text.hpp"

namespace scree::cli {
namespace {

struct EvaluateOptions {
  std::vector<std::string> files;
  bool as_json = false;
};

void evaluate(const EvaluateOptions& options) {
  Scorer scorer;
  for (std::size_t i = 0; i + 1 < options.files.size(); i += 2) {
    const auto truth = read_truth(options.files[i]);
    if (!truth) throw Failure(truth.error().message);
    scorer.add(*truth, read_detections(options.files[i + 1]));
  }
  const std::string text =
      options.as_json ? score_json(scorer.result()) : score_table(scorer.result());
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace

void add_evaluate(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "evaluate", "Score detections against truth; several pairs of files are summed up");
  auto options = std::make_shared<EvaluateOptions>();
  command
      ->add_option("FILES", options->files,
                   "truth.json, then the lists of `scree detect`; and so on")
      ->required()
      ->type_name("TRUTH DETECTIONS ...")
      ->check(CLI::ExistingFile);
  command->add_flag("--json", options->as_json, "for programs");
  command->callback([options] {
    if (options->files.size() % 2 != 0) {
      throw CLI::ValidationError("FILES", "to each truth belongs a file of detections");
    }
    evaluate(*options);
  });
}

}  // namespace scree::cli
