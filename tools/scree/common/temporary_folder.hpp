#pragma once

#include <filesystem>
#include <string>

namespace scree::cli {

/// A folder of this program alone, among the temporary files; removed with all that is in it.
class TemporaryFolder {
public:
  /// Throws Failure.
  explicit TemporaryFolder(const std::string& name);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  const std::filesystem::path& path() const { return path_; }

private:
  std::filesystem::path path_;
};

}  // namespace scree::cli
