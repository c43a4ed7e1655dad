#pragma once

#include <charconv>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "common/fresh_file.hpp"

namespace scree::cli {

/// CSV with the shortest digits that read back to the same number.
class CsvFile {
public:
  /// An empty name is the standard output. Throws Failure.
  explicit CsvFile(const std::string& name);

  void line(std::string_view text);
  template <class T>
  void value(T value) {
    char digits[64];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    text_.append(digits, end);
    text_ += ',';
  }
  /// A value that is not there.
  void nothing() { text_ += ','; }
  void end_line();
  /// Throws Failure where not everything could be written. What a file held stays until then.
  void close();

private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::FILE* file() { return owned_ ? owned_.get() : stdout; }
  void flush();

  FreshFile fresh_;
  std::string name_, text_;
  std::unique_ptr<std::FILE, Close> owned_;
};

}  // namespace scree::cli
