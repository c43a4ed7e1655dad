#include "common/fresh_file.hpp"

#include <fstream>
#include <system_error>

#include "commands.hpp"

namespace scree::cli {

namespace fs = std::filesystem;

FreshFile::FreshFile(const fs::path& file) : file_(file), fresh_(file) {
  std::error_code none;
  if (file.empty() || fs::is_other(file, none)) return;
  // Of a link what it leads to.
  if (const fs::path target = fs::canonical(file, none); !none) file_ = target;
  fresh_ = file_;
  fresh_ += ".new";
}

FreshFile::~FreshFile() {
  std::error_code none;
  if (fresh_ != file_) fs::remove(fresh_, none);
}

void FreshFile::take_place() {
  if (fresh_ == file_) return;
  std::error_code error;
  fs::rename(fresh_, file_, error);
  if (error) throw Failure("cannot write " + file_.string() + ": " + error.message());
  fresh_ = file_;
}

void write_whole(const fs::path& file, std::string_view text) {
  FreshFile fresh(file);
  std::ofstream stream(fresh.path(), std::ios::binary);
  stream << text << std::flush;
  if (!stream) throw Failure("cannot write " + file.string() + ": is the disk full?");
  fresh.take_place();
}

}  // namespace scree::cli
