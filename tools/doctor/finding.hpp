#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace scree {

/// What was found out about one thing that must be right.
struct Finding {
  enum class Verdict : std::uint8_t {
    ok,
    wrong,   ///< the text says what to do
    unknown  ///< it could not be looked at; the text says why
  };

  std::string subject;
  Verdict verdict = Verdict::ok;
  std::string text;
};

inline Finding ok(std::string subject, std::string text) {
  return {std::move(subject), Finding::Verdict::ok, std::move(text)};
}
inline Finding wrong(std::string subject, std::string text) {
  return {std::move(subject), Finding::Verdict::wrong, std::move(text)};
}
inline Finding unknown(std::string subject, std::string text) {
  return {std::move(subject), Finding::Verdict::unknown, std::move(text)};
}

}  // namespace scree
