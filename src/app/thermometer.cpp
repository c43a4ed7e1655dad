#include "thermometer.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

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
      if (is_temperature(file.filename())) sensors_.push_back(file);
    });
  };
  for_each_in(classes / "thermal", [&](const fs::path& zone) { add(zone, "type"); });
  for_each_in(classes / "hwmon", [&](const fs::path& monitor) { add(monitor, "name"); });
}

double Thermometer::celsius() const {
  double hottest = std::numeric_limits<double>::quiet_NaN();
  for (const fs::path& sensor : sensors_) {
    std::ifstream file(sensor);
    double thousandths = 0;
    if (file >> thousandths) hottest = std::fmax(hottest, thousandths / 1000);
  }
  return hottest;
}

}  // namespace scree
