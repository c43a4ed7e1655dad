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
    for (const SetupFinding& each : report) found_[static_cast<std::size_t>(each.fault)] = each;
  }
  std::vector<std::string> sentences() const {
    std::vector<std::string> sentences;
    for (const auto& each : found_) {
      if (each) sentences.push_back(sentence(*each));
    }
    return sentences;
  }

private:
  std::array<std::optional<SetupFinding>, kSetupFaults> found_;
};

}  // namespace scree::cli
