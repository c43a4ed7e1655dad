#include "page_faults.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace scree {
namespace {

/// The faults in a line "TID (NAME) STATE ..."; the name may hold blanks and parentheses.
PageFaults faults_in(const std::string& line) {
  const std::size_t begin = line.find('('), end = line.rfind(')');
  if (begin == std::string::npos || end == std::string::npos) return {};
  PageFaults faults{line.substr(begin + 1, end - begin - 1)};
  std::istringstream rest(line.substr(end + 1));
  std::string skipped;
  for (int field = 3; field < 10; ++field) rest >> skipped;  // up to flags
  std::int64_t of_children = 0;
  rest >> faults.minor >> of_children >> faults.major;
  return faults;
}

}  // namespace

std::vector<PageFaults> page_faults(const std::filesystem::path& threads) {
  std::vector<std::filesystem::path> folders;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(threads, error)) {
    folders.push_back(entry.path());
  }
  std::ranges::sort(folders, {}, [](const auto& folder) {
    return std::strtoll(folder.filename().c_str(), nullptr, 10);
  });
  std::vector<PageFaults> all;
  for (const auto& folder : folders) {
    std::ifstream file(folder / "stat");
    std::string line;
    if (std::getline(file, line)) all.push_back(faults_in(line));
  }
  return all;
}

}  // namespace scree
