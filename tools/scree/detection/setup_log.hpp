#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "scree/motion/setup_report.hpp"

namespace scree::cli {

/// Gathers over a capture which settings the sensors contradict, each as it was said last.
class SetupLog {
public:
  void add(const SetupReport& report) {
    report.for_each_slot(
        [this](std::size_t slot, const SetupFinding& each) { found_[slot] = each; });
  }
  std::vector<std::string> sentences() const {
    std::vector<std::string> sentences;
    for (const auto& each : found_) {
      if (each) sentences.push_back(sentence(*each));
    }
    return sentences;
  }

private:
  std::array<std::optional<SetupFinding>, kMostFindings> found_;
};

}  // namespace scree::cli
