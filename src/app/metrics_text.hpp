#pragma once

#include <scree/health_t.hpp>
#include <string>

namespace scree {

/// Health in the text format of Prometheus, for the textfile collector of its node_exporter. What
/// is no number is left out.
std::string metrics_text(const health_t& health);

}  // namespace scree
