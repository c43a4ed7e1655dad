#include "mistakes.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

namespace scree {

void Mistakes::add(std::string_view origin, std::uint32_t line, std::string_view sentence) {
  add_text(origin, line,
           line > 0 ? fmt::format("{}:{}: {}", origin, line, sentence)
                    : fmt::format("{}: {}", origin, sentence));
}

void Mistakes::add_text(std::string_view origin, std::uint32_t line, std::string text) {
  if (is_full()) return;
  const auto file = std::ranges::find(origins_, origin) - origins_.begin();
  // What a file says may be a terminal's control bytes.
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' '; }, '?');
  all_.push_back({static_cast<std::size_t>(file), line, std::move(text)});
}

Error Mistakes::error() const {
  auto sorted = all_;
  std::ranges::stable_sort(sorted, [](const Mistake& a, const Mistake& b) {
    return a.file != b.file ? a.file < b.file : a.line < b.line;
  });
  Error error;
  for (const Mistake& mistake : sorted) {
    error.message += (error.message.empty() ? "" : "\n") + mistake.text;
  }
  return error;
}

}  // namespace scree
