#include "app/thermometer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

/// A folder as /sys/class is.
class ThermometerTest : public testing::Test {
protected:
  void device(const std::string& folder, const std::string& name_file, const std::string& name) {
    std::filesystem::create_directories(classes_ / folder);
    classes_.write(folder + "/" + name_file, name + "\n");
  }
  double celsius() const { return Thermometer(classes_ / "").celsius(); }

  TemporaryFolder classes_;
};

TEST_F(ThermometerTest, IsNoNumberWithoutASensorOfTheProcessor) {
  EXPECT_TRUE(std::isnan(celsius()));
  device("thermal/thermal_zone0", "type", "iwlwifi_1");
  classes_.write("thermal/thermal_zone0/temp", "45000\n");
  EXPECT_TRUE(std::isnan(celsius()));
}

TEST_F(ThermometerTest, ReadsTheThermalZoneOfABoard) {
  device("thermal/thermal_zone0", "type", "battery");
  classes_.write("thermal/thermal_zone0/temp", "99000\n");
  device("thermal/thermal_zone1", "type", "CPU-therm");
  classes_.write("thermal/thermal_zone1/temp", "48250\n");
  EXPECT_EQ(celsius(), 48.25);
}

TEST_F(ThermometerTest, ReadsTheHottestOfAMonitorsSensors) {
  device("hwmon/hwmon3", "name", "k10temp");
  classes_.write("hwmon/hwmon3/temp1_input", "51500\n");
  classes_.write("hwmon/hwmon3/temp3_input", "62000\n");
  classes_.write("hwmon/hwmon3/temp3_label", "Tccd1\n");
  classes_.write("hwmon/hwmon3/temp1_max", "95000\n");
  classes_.write("hwmon/hwmon3/fan1_input", "95000\n");
  EXPECT_EQ(celsius(), 62);
}

TEST_F(ThermometerTest, LeavesOutASensorThatCannotBeRead) {
  device("hwmon/hwmon0", "name", "coretemp");
  classes_.write("hwmon/hwmon0/temp1_input", "");
  EXPECT_TRUE(std::isnan(celsius()));
  classes_.write("hwmon/hwmon0/temp2_input", "-5000\n");
  EXPECT_EQ(celsius(), -5);
}

}  // namespace
}  // namespace scree
