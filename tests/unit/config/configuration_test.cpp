#include "scree/config/configuration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class ConfigurationTest : public ::testing::Test {
protected:
  ConfigurationTest() { std::filesystem::create_directory(folder_ / "scree.d"); }

  std::filesystem::path write(std::string_view toml) { return folder_.write("scree.toml", toml); }
  std::string error_of(const std::filesystem::path& file) {
    const auto configuration = read_configuration(file);
    return configuration ? "no error" : configuration.error().message;
  }

  TemporaryFolder folder_;
};

TEST_F(ConfigurationTest, WhatScreedWouldRefuseIsRefused) {
  EXPECT_THAT(error_of(write("[encoder]\ninterface = 'averyverylonginterface'\n")),
              HasSubstr("scree.toml:2: encoder.interface is longer"));
  EXPECT_THAT(error_of(write("[gpio]\nstop = 'gpiochip0:5'\nheartbeat = 'gpiochip0:5'\n")),
              HasSubstr("must be different lines"));
}

TEST_F(ConfigurationTest, DropInsGoOverTheFileInTheOrderOfTheirNames) {
  const auto file = write("[lidar]\nport = 4000\nposition_port = 4001\nmin_range = 0.7\n");
  folder_.write("scree.d/20-second.toml", "[lidar]\n\nport = 6000\n");
  folder_.write("scree.d/10-first.toml", "[lidar]\nport = 5000\nposition_port = 5001\n");
  folder_.write("scree.d/30-kept-aside.toml.off", "[lidar]\nport = 7000\n");
  folder_.write("scree.d/.#40-of-an-editor.toml", "[lidar]\nport = 7000\n");
  const auto read = read_configuration(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->settings.lidar.port, 6000);
  EXPECT_EQ(read->settings.lidar.position_port, 5001);
  EXPECT_EQ(read->settings.lidar.min_range, 0.7);
  EXPECT_THAT(read->source_of("lidar.port").text(), EndsWith("scree.d/20-second.toml:3"));
  EXPECT_THAT(read->source_of("lidar.position_port").text(), EndsWith("10-first.toml:3"));
  EXPECT_THAT(read->source_of("lidar.min_range").text(), EndsWith("scree.toml:4"));
  EXPECT_EQ(read->source_of("lidar.max_range").text(), "default");
}

TEST_F(ConfigurationTest, MistakesInADropInNameIt) {
  const auto file = write("[lidar]\nmax_range = 20.0\n");
  folder_.write("scree.d/robot.toml", "[lidar]\nmin_range = 25.0\n");
  EXPECT_THAT(error_of(file), HasSubstr("robot.toml:2: lidar.min_range must be below"))
      << "of two that contradict each other";
  folder_.write("scree.d/robot.toml", "[imu]\n\nbuad = 115200\n");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("scree.d/robot.toml:3: imu.buad"),
                                    HasSubstr("the nearest is imu.baud")));
  folder_.write("scree.d/robot.toml", "[imu]\nbaud = 115200\nbaud = 921600\n");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("scree.d/robot.toml:3"), HasSubstr("baud")));
  std::filesystem::create_directory(folder_ / "scree.d/folder.toml");
  EXPECT_THAT(error_of(file), HasSubstr("folder.toml")) << "the first of the files";
}

TEST_F(ConfigurationTest, MistakesStandInTheOrderOfTheFiles) {
  const auto file = write("[imu]\n\nrate = 1\n");
  folder_.write("scree.d/a.toml", "[lidar]\nsender = \"velodyne.local\"\n");
  folder_.write("scree.d/b.toml", "x = 1\n");
  const auto read = read_configuration(file, [](const Configuration&) {
    return std::vector<KeyMistake>{{"lidar.sender", "is no address"}, {"lcm.url", "is odd"}};
  });
  ASSERT_FALSE(read);
  const std::string& all = read.error().message;
  EXPECT_THAT(all, HasSubstr("a.toml:2: lidar.sender: is no address\n"));
  EXPECT_LT(all.find("scree.toml: lcm.url: is odd"), all.find("scree.toml:3: imu.rate"));
  EXPECT_LT(all.find("scree.toml:3: imu.rate"), all.find("a.toml:2: lidar.sender"));
  EXPECT_LT(all.find("a.toml:2: lidar.sender"), all.find("b.toml:1: x"));
}

TEST_F(ConfigurationTest, AFileThatAKeyNamesMustBeThere) {
  EXPECT_THAT(error_of(write("[encoder]\nsignal = \"A.B\"\nscale = 1.0\ndbc = \"none.dbc\"\n")),
              AllOf(HasSubstr("scree.toml:4: encoder.dbc"), HasSubstr("none.dbc")));
  EXPECT_THAT(error_of(write("[detect.map]\nnetwork = \"mine.txt\"\n")),
              AllOf(HasSubstr("scree.toml:2: detect.map.network"), HasSubstr("mine.txt")));
  folder_.write("mine.txt", "");
  EXPECT_EQ(error_of(folder_ / "scree.toml"), "no error");
}

TEST_F(ConfigurationTest, OnlyRegularFilesOfAPlausibleSizeAreRead) {
  EXPECT_THAT(error_of("/dev/zero"), HasSubstr("cannot read /dev/zero: it is no regular file"));
  const auto fifo = folder_ / "fifo.toml";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_THAT(error_of(fifo), HasSubstr("fifo.toml: it is no regular file"));
  EXPECT_THAT(error_of(folder_.path()), HasSubstr("it is a folder"));
  EXPECT_THAT(error_of(write(std::string((1 << 20) + 1, '\n'))), HasSubstr("longer than"));
}

TEST_F(ConfigurationTest, EffectiveTextReadsBackToTheSameText) {
  const auto file = write("[lidar]\nport = 4000\nmodel = \"puck_lite\"\n[stop]\nlength = 4.5\n");
  folder_.write("scree.d/robot.toml", "[encoder]\ncan_id = 0x18FF1234\n");
  const auto read = read_configuration(file);
  ASSERT_TRUE(read) << read.error().message;
  const std::string all = effective_toml(*read, Shown::all),
                    set = effective_toml(*read, Shown::set),
                    owners = effective_toml(*read, Shown::owners);
  EXPECT_THAT(all, AllOf(HasSubstr("port = 4000 "), HasSubstr("# default")));
  EXPECT_THAT(set, AllOf(HasSubstr("can_id = 0x18FF1234"), HasSubstr("robot.toml:2"),
                         Not(HasSubstr("# default")), Not(HasSubstr("[imu]"))));
  EXPECT_THAT(owners, AllOf(HasSubstr("[imu]"), Not(HasSubstr("[detect.map]"))));
  for (const std::string& text : {all, owners, set}) {
    const auto again = parse_settings(text, "again");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(toml_values(*again), toml_values(read->settings));
  }
}

TEST_F(ConfigurationTest, StringsAreEscapedSoThatTheyReadBack) {
  std::filesystem::create_directory(folder_ / "a\nb");
  const auto file = folder_.write("a\nb/scree.toml",
                                  "[imu]\ndevice = \"/dev/a\\\"b\\\\c\\u0001\"\n"
                                  "[lcm]\nurl = \"a\\nb\\té\"\n[encoder]\ninterface = 'a\"\\'\n");
  const auto read = read_configuration(file);
  ASSERT_TRUE(read) << read.error().message;
  const std::string text = effective_toml(*read, Shown::set);
  const auto again = parse_settings(text, "again");
  ASSERT_TRUE(again) << again.error().message << text;
  EXPECT_EQ(again->imu.device, "/dev/a\"b\\c\x01");
  EXPECT_EQ(again->lcm.url, "a\nb\té");
  EXPECT_EQ(again->encoder.interface, "a\"\\");
}

TEST_F(ConfigurationTest, AProfileBesideTheFileIsReadInsteadOfTheShippedOne) {
  folder_.write("map.toml",
                "[detect.map]\nsaddle = 0.6\nbody_height = 0.09\n[track]\nsmoothing = 0.5\n");
  const auto file = write("[track]\nsmoothing = 0.6\n");
  const auto read = read_configuration(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->settings.detect_map.surface.body_height, 0.09);
  EXPECT_EQ(read->settings.track.smoothing, 0.6) << "the file goes over it";
  EXPECT_THAT(read->source_of("detect.map.body_height").text(), EndsWith("map.toml:3"));
  EXPECT_TRUE(read->source_of("detect.map.saddle").is_default()) << "it says what holds anyway";
  const std::string set = effective_toml(*read, Shown::set);
  EXPECT_THAT(set, AllOf(HasSubstr("body_height = 0.09"), HasSubstr("smoothing = 0.6"),
                         Not(HasSubstr("saddle"))));
  folder_.write("map.toml", "[detect.map]\nseed_distance = 0.4\n");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("map.toml:2: detect.map.seed_distance"),
                                    HasSubstr("method = \"edges\"")));
}

TEST_F(ConfigurationTest, AMethodChosenLaterLeavesNoKeyUnreadInSilence) {
  const auto file = write("[detect.cloud]\nbody_height = 0.1\n");
  EXPECT_EQ(error_of(file), "no error");
  folder_.write("scree.d/robot.toml",
                "[detect.cloud]\nmethod = \"edges\"\nnetwork = \"network_paper.txt\"\n");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("scree.toml:2: detect.cloud.body_height"),
                                    HasSubstr("was set for method = \"surface\"")));
  write("[detect.cloud]\nkernel_spacing = 0.1\n");
  EXPECT_THAT(error_of(file), HasSubstr("scree.toml:2: detect.cloud.kernel_spacing"))
      << "of a name that both methods have";
}

}  // namespace
}  // namespace scree
