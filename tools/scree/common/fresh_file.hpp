#pragma once

#include <filesystem>
#include <string_view>

namespace scree::cli {

/// A file that takes the place of what is there when it is whole, so that a failure leaves that as
/// it was. Devices and pipes are written at once.
class FreshFile {
public:
  /// @param file empty: none
  explicit FreshFile(const std::filesystem::path& file);
  FreshFile(const FreshFile&) = delete;
  FreshFile& operator=(const FreshFile&) = delete;
  /// Removes what did not become whole.
  ~FreshFile();

  /// Where to write.
  const std::filesystem::path& path() const { return fresh_; }
  /// To be called when all is written and closed. Throws Failure.
  void take_place();

private:
  std::filesystem::path file_, fresh_;
};

/// Writes a file that is whole or not there. Throws Failure.
void write_whole(const std::filesystem::path& file, std::string_view text);

}  // namespace scree::cli
