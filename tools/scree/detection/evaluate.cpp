#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "common/outputs.hpp"
#include "detection/detections.hpp"
#include "detection/score_text.hpp"

namespace scree::cli {
namespace {

struct EvaluateOptions {
  std::vector<std::string> files;
  bool as_json = false;
  std::string matches;
  Outputs outputs;
};

/// What each list got right and wrong, as lines of JSON.
class MatchFile {
public:
  /// @param file empty for none. Throws Failure.
  explicit MatchFile(const std::string& file) : name_(file) {
    if (name_.empty()) return;
    file_.open(name_);
    if (!file_) throw Failure("cannot write " + name_);
  }

  void write(std::size_t run, const ObstacleList& list, const Comparison& comparison) {
    if (name_.empty()) return;
    nlohmann::ordered_json right = nlohmann::ordered_json::array(), missed = right,
                           invented = right;
    for (const Comparison::Asked& asked : comparison.asked) {
      if (asked.is_right()) {
        right.push_back({asked.obstacle->id, asked.detection->id, asked.range});
      } else {
        missed.push_back({asked.obstacle->id, asked.range});
      }
    }
    for (const auto& alarm : comparison.false_alarms) {
      invented.push_back({alarm.detection->id, alarm.range});
    }
    const nlohmann::ordered_json line = {{"run", run},
                                         {"stamp_ns", list.stamp_ns},
                                         {"right", right},
                                         {"missed", missed},
                                         {"invented", invented}};
    file_ << line << '\n';
  }
  void finish() {
    if (!name_.empty() && !file_.flush()) throw Failure("cannot write " + name_);
  }

private:
  std::string name_;
  std::ofstream file_;
};

void evaluate(const EvaluateOptions& options) {
  options.outputs.require_free({options.matches}, {options.files.begin(), options.files.end()});
  Scorer scorer;
  MatchFile matches(options.matches);
  for (std::size_t i = 0; i + 1 < options.files.size(); i += 2) {
    const auto truth = read_truth(options.files[i]);
    if (!truth) throw Failure(truth.error().message);
    scorer.add(*truth, read_detections(options.files[i + 1]),
               [&](const ObstacleList& list, const Comparison& comparison) {
                 matches.write(i / 2, list, comparison);
               });
  }
  matches.finish();
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
  command
      ->add_option(
          "--matches", options->matches,
          "JSON lines file: of each list what was right (id of truth, id, metres away), missed and "
          "invented")
      ->type_name("FILE");
  options->outputs.add_to(*command);
  command->callback([options] {
    if (options->files.size() % 2 != 0) {
      throw CLI::ValidationError("FILES", "to each truth belongs a file of detections");
    }
    evaluate(*options);
  });
}

}  // namespace scree::cli
