#include "scree/config/reload.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scree/config/keys.hpp"

namespace scree {
namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Reload, NothingChanges) {
  const Reload same = reload(Settings(), Settings());
  EXPECT_THAT(same.applied, IsEmpty());
  EXPECT_THAT(same.refused, IsEmpty());
}

TEST(Reload, TakesOverWhatCanChangeAndNamesWhatCannot) {
  Settings running, wanted;
  running.lidar.port = 4000;
  wanted.lidar.port = 5000;
  wanted.lidar.translation.z() = 1;
  wanted.lidar.model = LidarModel::puck_hires;
  wanted.stop.length = 7;
  wanted.map.wait = 0.2;
  wanted.map.voxel = 0.2;
  wanted.track.reach = 3;
  wanted.track.network = "other.txt";
  wanted.detect_map.network = "other.txt";
  const Reload change = reload(running, wanted);
  EXPECT_THAT(change.applied, ElementsAre("stop.length", "map.wait", "track.reach"));
  EXPECT_THAT(change.refused, ElementsAre("lidar.model", "lidar.port", "lidar.translation",
                                          "map.voxel", "detect.map.network", "track.network"));
  EXPECT_EQ(change.settings.lidar.port, 4000);
  EXPECT_EQ(change.settings.stop.length, 7);
  EXPECT_EQ(change.settings.track.reach, 3);
  EXPECT_EQ(change.settings.map.voxel, running.map.voxel);
}

TEST(Reload, ASecondTimeSaysAgainWhatNeedsARestart) {
  Settings wanted;
  wanted.imu.baud = 115200;
  const Settings after = reload(Settings(), wanted).settings;
  EXPECT_THAT(reload(after, wanted).refused, ElementsAre("imu.baud"));
}

TEST(Reload, TheKeysInWordsAreThoseThatChange) {
  Settings other;
  // Another value for every key, whatever it means.
  for_each_key(other, []<class Value>(const Key&, Value& value) {
    if constexpr (std::is_same_v<Value, std::string>) {
      value += "x";
    } else if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      value.x() += 1;
    } else {
      value = value == Value{} ? static_cast<Value>(1) : Value{};
    }
  });
  const Reload change = reload(Settings(), other);
  for (const std::string& name : change.applied) {
    std::string table = "[";
    table.append(name, 0, name.rfind('.')).push_back(']');
    EXPECT_THAT(std::string(kReloadableKeys), AnyOf(HasSubstr(table), HasSubstr(name)));
  }
  EXPECT_THAT(change.applied, Contains("stop.hold"));
  EXPECT_THAT(change.refused, Contains("lidar.port"));
}

}  // namespace
}  // namespace scree
