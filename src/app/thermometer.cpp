#include "thermometer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

namespace scree {
namespace {

namespace fs = std::filesystem;

/// "cpu-thermal" and the like of boards, Intel's package; drivers of AMD's and Intel's sensors.
constexpr std::array<std::string_view, 6> kProcessors = {"cpu",     "soc",      "x86_pkg_temp",
                                                         "k10temp", "coretemp", "zenpower"};

bool is_processor(const fs::path& named) {
  std::ifstream file(named);
  std::string name;
  std::getline(file, name);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::any_of(
      kProcessors, [&](std::string_view word) { return name.find(word) != std::string::npos; });
}

bool is_temperature(const std::string& file) {
  return file.starts_with("temp") && (file.ends_with("_input") || file == "temp");
}

/// Calls with each entry of a folder, which may be missing.
template <class Do>
void for_each_in(const fs::path& folder, Do&& take) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) take(entry.path());
}

}  // namespace

Thermometer::Thermometer(const fs::path& classes) {
  const auto add = [this](const fs::path& device, const char* name) {
    if (!is_processor(device / name)) return;
    for_each_in(device, [this](const fs::path& file) {
      if (!is_temperature(file.filename())) return;
      Descriptor sensor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
      if (sensor.is_open()) sensors_.push_back(std::move(sensor));
    });
  };
  for_each_in(classes / "thermal", [&](const fs::path& zone) { add(zone, "type"); });
  for_each_in(classes / "hwmon", [&](const fs::path& monitor) { add(monitor, "name"); });
}

double Thermometer::celsius() const {
  double hottest = std::numeric_limits<double>::quiet_NaN();
  for (const Descriptor& sensor : sensors_) {
    std::array<char, 32> text;  // NOLINT(cppcoreguidelines-pro-type-member-init): pread() fills it
    const ssize_t size = pread(sensor.get(), text.data(), text.size(), 0);
    double thousandths = 0;
    if (size <= 0) continue;
    const auto [end, error] = std::from_chars(text.data(), text.data() + size, thousandths);
    if (error == std::errc()) hottest = std::fmax(hottest, thousandths / 1000);
  }
  return hottest;
}

}  // namespace scree
