#include "decode/csv_file.hpp"

#include "commands.hpp"

namespace scree::cli {
namespace {

constexpr std::size_t kFull = 1 << 20;

}  // namespace

CsvFile::CsvFile(const std::string& name)
    : fresh_(name), name_(name.empty() ? "standard output" : name) {
  if (!name.empty()) {
    owned_.reset(std::fopen(fresh_.path().c_str(), "wb"));
    if (!owned_) throw Failure("cannot write " + name);
  }
  text_.reserve(kFull + 1024);
}

void CsvFile::line(std::string_view text) {
  text_ += text;
  text_ += '\n';
}

void CsvFile::end_line() {
  // Every value is followed by a comma, and the last one's makes room for the end of the line.
  if (!text_.empty()) text_.back() = '\n';
  if (text_.size() > kFull) flush();
}

void CsvFile::close() {
  flush();
  if (std::fflush(file()) != 0) throw Failure("cannot write " + name_);
  if (!owned_) return;
  owned_.reset();
  fresh_.take_place();
}

void CsvFile::flush() {
  if (std::fwrite(text_.data(), 1, text_.size(), file()) != text_.size()) {
    throw Failure("cannot write " + name_);
  }
  text_.clear();
}

}  // namespace scree::cli
