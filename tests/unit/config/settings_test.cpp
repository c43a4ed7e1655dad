#include "scree/config/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "scree/config/keys.hpp"
#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string error_of(std::string_view toml) {
  const auto settings = parse_settings(toml, "robot.toml");
  return settings ? "no error" : settings.error().message;
}

TEST(Settings, EmptyFileGivesDefaults) {
  const auto settings = parse_settings("", "robot.toml");
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(settings->lidar.port, 2368);
  EXPECT_EQ(settings->encoder.can_id, 0x1A0);
}

TEST(Settings, ReadsEveryKindOfValue) {
  const auto settings = parse_settings(
      "[lidar]\nmodel = \"puck_hires\"\nport = 2369\ntranslation = [0.1, 0, 0.95]\nmax_range = 40\n"
      "[imu]\nconfigure = false\nrate = 400\ngyro_hr_rate = 1000\n"
      "[encoder]\ncan_id = 0x18FF1234\nsigned = false\n[detect.cloud]\nleaf_size = 0.1\n",
      "robot.toml");
  ASSERT_TRUE(settings) << settings.error().message;
  EXPECT_EQ(settings->lidar.model, LidarModel::puck_hires);
  EXPECT_EQ(settings->lidar.port, 2369);
  EXPECT_EQ(settings->lidar.translation, Eigen::Vector3d(0.1, 0, 0.95));
  EXPECT_EQ(settings->lidar.max_range, 40.0);
  EXPECT_FALSE(settings->imu.configure);
  EXPECT_EQ(settings->imu.rate, 400);
  EXPECT_EQ(settings->imu.gyro_hr_rate, 1000);
  EXPECT_EQ(settings->encoder.can_id, 0x18FF1234);
  EXPECT_FALSE(settings->encoder.is_signed);
  EXPECT_EQ(settings->detect_cloud.leaf_size, 0.1);
}

TEST(Settings, MistakesNameFileLineKeyAndWhatIsAccepted) {
  EXPECT_THAT(error_of("[lidar]\nport = 70000\n"),
              AllOf(HasSubstr("robot.toml:2: lidar.port"), HasSubstr("1 to 65535")));
  EXPECT_THAT(error_of("[lidar]\nport = 1.5\n"), HasSubstr("whole number, accepted is 1 to 65535"));
  EXPECT_THAT(error_of("[lidar]\nmodel = \"hdl64\"\n"),
              AllOf(HasSubstr("lidar.model"), HasSubstr("\"puck_lite\"")));
  EXPECT_THAT(error_of("[lidar]\ntranslation = [1, 2]\n"),
              HasSubstr("three numbers, [x, y, z], accepted is -100 to 100 m"));
  EXPECT_THAT(error_of("[lidar]\n\nprot = 2368\n"),
              AllOf(HasSubstr("robot.toml:3"),
                    HasSubstr("lidar.prot is not a setting; the nearest is lidar.port")));
  EXPECT_THAT(error_of("[radar]\nx = 1\n"),
              HasSubstr("radar is not a setting; the nearest is lidar"));
  EXPECT_THAT(error_of("lidar = 3\n"), HasSubstr("lidar is a table"));
  EXPECT_THAT(error_of("[lidar\n"), HasSubstr("robot.toml:1"));
  EXPECT_THAT(error_of("[lidar]\nmin_range = 31\n"), HasSubstr("below lidar.max_range"));
  EXPECT_THAT(error_of("[lidar]\nmax_range = nan\n"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("[detect.cloud]\nground_inner = 5\n"),
              AllOf(HasSubstr("robot.toml:2"), HasSubstr("ground_outer")));
  EXPECT_THAT(error_of("[detect.map]\n\nground = \"ring\"\ncandidates = \"edges\"\n"),
              AllOf(HasSubstr("robot.toml:3"), HasSubstr("\"regions\" needs")));
  EXPECT_THAT(error_of("[lidar]\nport = 1\nport = 2\n"),
              AllOf(HasSubstr("robot.toml:3"), HasSubstr("port")));
}

TEST(Settings, ContradictionsOfTheEncoderAreOneSentence) {
  EXPECT_THAT(error_of("[encoder]\nstart_bit = 500\n"), HasSubstr("beyond the 64 bytes"));
  EXPECT_THAT(error_of("[encoder]\nstart_bit = 487\nbyte_order = \"big_endian\"\n"), "no error");
  EXPECT_THAT(error_of("[encoder]\nstart_bit = 486\nbyte_order = \"big_endian\"\n"),
              HasSubstr("beyond the 64 bytes"));
  EXPECT_THAT(error_of("[encoder]\nscale = 0\n"), HasSubstr("must not be 0"));
  EXPECT_THAT(error_of("[encoder]\nsignal = \"A.B\"\n"),
              HasSubstr("encoder.dbc and encoder.signal"));
  EXPECT_THAT(error_of("[encoder]\ndbc = \"a.dbc\"\nsignal = \"A.B\"\n"),
              HasSubstr("encoder.dbc needs encoder.scale"));
  EXPECT_EQ(error_of("[encoder]\ndbc = \"a.dbc\"\nsignal = \"A.B\"\nscale = 1\n"), "no error");
}

TEST(Settings, MissingFileIsOneSentence) {
  const auto settings = load_settings("/nonexistent/scree.toml");
  ASSERT_FALSE(settings);
  EXPECT_THAT(settings.error().message, HasSubstr("/nonexistent/scree.toml"));
}

TEST(FindFile, LooksBesideTheConfigurationThenBesideTheProgram) {
  const TemporaryFolder folder;
  const auto own = folder.write("network_map.txt", "");
  EXPECT_EQ(find_file("network_map.txt", folder / "robot.toml"), own);
  EXPECT_EQ(find_file(own.string(), ""), own);

  std::filesystem::current_path(folder / "");
  EXPECT_EQ(find_file("network_map.txt", "robot.toml"), "network_map.txt");
  const auto shipped = find_file("network_map.txt", "");
  std::filesystem::current_path("/");
  ASSERT_TRUE(shipped) << shipped.error().message;
  EXPECT_EQ(shipped->parent_path().filename(), "scree")
      << "a file that lies in the current folder by chance is not taken";

  const auto missing = find_file("nowhere.txt", folder / "robot.toml");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("cannot find nowhere.txt"));
}

TEST(Settings, DefaultFileReadsBackAndIsStable) {
  const std::string text = default_settings_toml();
  const auto settings = parse_settings(text, "default");
  ASSERT_TRUE(settings) << settings.error().message;
}

TEST(Settings, ShippedPaperFileIsThePapersMethod) {
  const auto settings = load_settings(std::string(SCREE_SOURCE) + "/config/paper.toml");
  ASSERT_TRUE(settings) << settings.error().message;
  const auto text_of = [](DetectSettings detect) {
    std::ostringstream text;
    for_each_detect_key("detect.cloud", detect, [&](const Key& key, const auto& value) {
      text << key.name << ' ';
      if constexpr (std::is_enum_v<std::decay_t<decltype(value)>>) {
        text << name_of(value) << '\n';
      } else {
        text << value << '\n';
      }
    });
    return text.str();
  };
  EXPECT_EQ(text_of(settings->detect_cloud), text_of(DetectSettings::for_paper()));
}

/// The shipped file is this very text; SCREE_UPDATE=1 in the environment writes it anew.
TEST(Settings, ShippedFileIsTheDefaults) {
  const std::string shipped = std::string(SCREE_SOURCE) + "/config/scree.toml";
  if (std::getenv("SCREE_UPDATE") != nullptr) std::ofstream(shipped) << default_settings_toml();
  std::ostringstream text;
  text << std::ifstream(shipped).rdbuf();
  EXPECT_EQ(text.str(), default_settings_toml());
}

TEST(Settings, DefaultsLieInTheirRanges) {
  const Settings settings;
  for_each_key(settings, [](const Key& key, const auto& value) {
    EXPECT_FALSE(key.meaning.empty()) << key.name;
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
      if (key.low < key.high) {
        EXPECT_GE(static_cast<double>(value), key.low) << key.table << '.' << key.name;
        EXPECT_LE(static_cast<double>(value), key.high) << key.table << '.' << key.name;
      }
    }
  });
}

}  // namespace
}  // namespace scree
