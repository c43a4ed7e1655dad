#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace scree::cli {

/// The page of a report: one HTML file that needs nothing else.
/// @param data as ReportData::pack() gives it
std::string report_page(const std::string& title, std::span<const std::uint8_t> data);

/// The same page for what comes live. It asks the server that it came from.
std::string live_page();

}  // namespace scree::cli
