#pragma once

#include <filesystem>

#include "report/report_data.hpp"

namespace scree::cli {

/// Runs the pipeline over a capture, and gathers what it says. Throws Failure.
/// @param config empty for the capture's own
void gather_capture(const std::filesystem::path& capture, const std::filesystem::path& config,
                    ReportData& data);

/// Gathers lists, health and grids of an LCM log, or of JSON lines as `scree detect` and
/// `scree watch --json --health` print them. Throws Failure.
/// @param grids JSON lines of `scree detect --grid`; empty for none
void gather_lists(const std::filesystem::path& lists, const std::filesystem::path& grids,
                  ReportData& data);

/// Whether a file holds lists, not sensor data. Throws Failure where it cannot be read.
bool holds_lists(const std::filesystem::path& file);

}  // namespace scree::cli
