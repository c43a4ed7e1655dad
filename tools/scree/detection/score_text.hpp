#pragma once

#include <string>

#include "scoring/scoring.hpp"

namespace scree::cli {

/// Tables for people; "-" stands for a share of nothing.
std::string score_table(const ScoringResult& result);

/// The same for programs: one JSON object, indented, with a line feed. Metres, seconds; angles in
/// degrees and named so; null for a share of nothing.
std::string score_json(const ScoringResult& result);

}  // namespace scree::cli
