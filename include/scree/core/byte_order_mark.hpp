#pragma once

#include <string_view>

namespace scree {

/// Of UTF-8: editors of Windows begin a text with it.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace scree
