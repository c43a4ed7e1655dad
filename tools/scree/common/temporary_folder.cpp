#include "common/temporary_folder.hpp"

#include <cstdlib>
#include <system_error>

#include "commands.hpp"

namespace scree::cli {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::string path = (fs::temp_directory_path() / (name + "-XXXXXX")).string();
  if (mkdtemp(path.data()) == nullptr) throw Failure("cannot make a folder like " + path);
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

}  // namespace scree::cli
