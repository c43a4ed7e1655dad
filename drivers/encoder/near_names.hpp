#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace scree::encoder {

/// The (at most three) names that are nearest to a mistyped one, as "A, B, C".
std::string near_names(std::string_view wanted, std::vector<std::string_view> names);

}  // namespace scree::encoder
