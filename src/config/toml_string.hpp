#pragma once

#include <string>
#include <string_view>

namespace scree {

/// A text as a TOML string in quotes, on one line, with escapes where they are needed.
/// @pre the text is UTF-8, as all of TOML is
std::string toml_string(std::string_view text);

}  // namespace scree
