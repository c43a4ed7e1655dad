#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The names that are nearest to a mistyped one, at most so many, as "A, B, C".
std::string near_names(std::string_view wanted, const std::vector<std::string_view>& names,
                       std::size_t most = 3);

/// The name that a mistyped one was meant to be; empty where more than half of its letters would
/// have to change.
std::string nearest_name(std::string_view wanted, const std::vector<std::string_view>& names);

}  // namespace scree
