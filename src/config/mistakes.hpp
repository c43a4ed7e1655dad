#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scree/core/result.hpp"

namespace scree {

/// What is wrong in a configuration. It may be much at once.
class Mistakes {
public:
  /// The files in the order in which they are read.
  void begin_file(std::string origin) { origins_.push_back(std::move(origin)); }
  /// @param line 0 where a mistake stands in no line
  void add(std::string_view origin, std::uint32_t line, std::string_view sentence);
  /// @param sentence names the file itself
  void add(std::string_view origin, std::string sentence) {
    add_text(origin, 0, std::move(sentence));
  }

  bool empty() const { return all_.empty(); }
  /// To look for more would be a waste of time: nobody reads so many.
  bool is_full() const { return all_.size() >= kMost; }
  /// A line each, in the order of files and lines.
  Error error() const;

private:
  static constexpr std::size_t kMost = 50;

  struct Mistake {
    std::size_t file;
    std::uint32_t line;
    std::string text;
  };
  void add_text(std::string_view origin, std::uint32_t line, std::string text);

  std::vector<std::string> origins_;
  std::vector<Mistake> all_;
};

}  // namespace scree
