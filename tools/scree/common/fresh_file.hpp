#pragma once

#include <filesystem>

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

}  // namespace scree::cli
