#pragma once

#include <string>
#include <string_view>

namespace scree {

/// A text whose letters of ASCII are small ones, whatever the locale.
inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

}  // namespace scree
