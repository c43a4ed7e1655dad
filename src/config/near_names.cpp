#include "scree/config/near_names.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace scree {
namespace {

constexpr std::size_t kLongest = 128;  // each distance takes the product of two lengths

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Least number of letters to insert, remove or replace (Levenshtein), whatever their case.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string near_names(std::string_view wanted, const std::vector<std::string_view>& names,
                       std::size_t most) {
  wanted = wanted.substr(0, kLongest);
  std::set<std::pair<std::size_t, std::string_view>> nearest;
  for (const std::string_view name : names) {
    if (name.size() <= kLongest) nearest.emplace(distance(wanted, name), name);
    if (nearest.size() > most) nearest.erase(std::prev(nearest.end()));
  }
  std::string text;
  for (const auto& [letters, name] : nearest) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text;
}

std::string nearest_name(std::string_view wanted, const std::vector<std::string_view>& names) {
  const std::string nearest = near_names(wanted, names, 1);
  return 2 * distance(wanted.substr(0, kLongest), nearest) <= wanted.size() ? nearest : "";
}

}  // namespace scree
