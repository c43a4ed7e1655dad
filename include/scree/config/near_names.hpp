#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// The names that are nearest to a mistyped one, at most so many, as "A, B, C".
std::string near_names(std::string_view wanted, const std::vector<std::string_view>& names,
                       std::size_t most = 3);

}  // namespace scree
