#include "app/running_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using ::testing::HasSubstr;

TEST(RunningConfig, ABadFileLeavesTheOldSettings) {
  const TemporaryFolder folder;
  const auto write = [&](const char* text) { return folder.write("robot.toml", text); };
  const auto file = write("[stop]\nlength = 3.0\n[lidar]\nport = 4000\n");
  auto config = RunningConfig::read(file);
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->settings().stop.length, 3.0);

  write("[stop]\nlength = -1.0\n");
  EXPECT_FALSE(config->reread());
  EXPECT_EQ(config->settings().stop.length, 3.0);
  write("[encoder]\ndbc = \"none.dbc\"\nsignal = \"A.B\"\nscale = 1.0\n[stop]\nlength = 9.0\n");
  EXPECT_FALSE(config->reread()) << "the DBC file is not there";
  EXPECT_EQ(config->settings().stop.length, 3.0);

  folder.write("cut.dbc", "BO_ 416 M: 8 X\n SG_ S : 0|8@1+ (1,");
  write("[encoder]\ndbc = \"cut.dbc\"\nsignal = \"M.S\"\nscale = 1.0\n[stop]\nlength = 9.0\n");
  EXPECT_FALSE(config->reread()) << "the DBC file breaks off";
  EXPECT_EQ(config->settings().stop.length, 3.0);

  write("[stop]\nlength = 9.0\n[lcm]\nurl = \"udpm://127.0.0.1:7667\"\n");
  EXPECT_FALSE(config->reread()) << "no start would take that url";
  EXPECT_EQ(config->settings().stop.length, 3.0);

  write("[stop]\nlength = 5.0\n[track]\nreach = 4.0\n[map]\nwait = 0.1\n[lidar]\nport = 5000\n");
  EXPECT_TRUE(config->reread());
  EXPECT_EQ(config->settings().stop.length, 5.0);
  EXPECT_EQ(config->settings().track.reach, 4.0);
  EXPECT_EQ(config->settings().map.wait, 0.1);
  EXPECT_EQ(config->settings().lidar.port, 4000) << "bound already";
  EXPECT_FALSE(config->reread()) << "nothing new";
}

TEST(RunningConfig, FilesThatItWouldReplaceOrCannotMakeAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const auto config = RunningConfig::read(folder.write("robot.toml", text));
    return config ? "" : config.error().message;
  };
  const std::string here = folder.write("plain", "").string();
  const auto file = [&](const std::string& path) {
    return refusal("[metrics]\nfile = \"" + path + "\"\n");
  };
  const auto box = [&](const std::string& path) {
    return refusal("[blackbox]\nfolder = \"" + path + "\"\n");
  };
  EXPECT_EQ(file(here), "");
  EXPECT_EQ(file(here + ".prom"), "");
  EXPECT_THAT(file("/dev/null"), HasSubstr("metrics.file: /dev/null is no plain file"));
  EXPECT_THAT(file("/tmp"), HasSubstr("is no plain file"));
  EXPECT_THAT(file("/nowhere/a.prom"), HasSubstr("there is no folder /nowhere"));
  EXPECT_EQ(box(here + "_box/deeper"), "");
  EXPECT_THAT(box(here), HasSubstr("blackbox.folder: " + here + " is no folder"));
  EXPECT_THAT(box(here + "/box"), HasSubstr(here + " is no folder"));
}

}  // namespace
}  // namespace scree
