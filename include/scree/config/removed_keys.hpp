#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace scree {

/// What to write instead of a key that older configuration files have, as "table.key"; nothing for
/// a name that never was one.
std::optional<std::string> replacement_of(std::string_view name);

}  // namespace scree
