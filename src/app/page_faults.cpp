#include "page_faults.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace scree {
namespace {

/// The field before the first blank, which is taken off.
std::string_view next_field(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const std::string_view field = line.substr(0, line.find(' '));
  line.remove_prefix(field.size());
  return field;
}

std::optional<std::int64_t> number(std::string_view field) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return {};
  return value;
}

}  // namespace

std::optional<PageFaults> page_faults_in(std::string_view line) {
  constexpr int kMinor = 10, kMajor = 12;        // fields, the first is 1
  const std::size_t name_end = line.rfind(')');  // a name may hold blanks and parentheses
  if (name_end == std::string_view::npos) return {};
  line.remove_prefix(name_end + 1);
  std::optional<std::int64_t> minor, major;
  for (int field = 3; field <= kMajor; ++field) {
    const std::string_view text = next_field(line);
    if (field == kMinor) minor = number(text);
    if (field == kMajor) major = number(text);
  }
  if (!minor || !major) return {};
  return PageFaults{*minor, *major};
}

void ThreadPageFaults::open() {
  file_ = Descriptor(::open("/proc/thread-self/stat", O_RDONLY | O_CLOEXEC));
  is_open_ = file_.is_open();
}

std::optional<PageFaults> ThreadPageFaults::read() const {
  if (!is_open_) return {};
  std::array<char, 512> line;  // NOLINT(cppcoreguidelines-pro-type-member-init): pread() fills it
  const ssize_t size = pread(file_.get(), line.data(), line.size(), 0);
  if (size <= 0) return {};
  return page_faults_in({line.data(), static_cast<std::size_t>(size)});
}

}  // namespace scree
