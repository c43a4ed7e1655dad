#include "scree/config/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "scree/config/configuration.hpp"
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

TEST(Settings, ReadsBoxesByAnyTwoCorners) {
  const auto settings =
      parse_settings("[robot]\nbody = [[[0.5, 0, 1], [-0.5, 1, 0]], [[1, 1, 1], [2, 2, 2]]]\n", "");
  ASSERT_TRUE(settings) << settings.error().message;
  ASSERT_EQ(settings->robot.body.size(), 2U);
  EXPECT_EQ(settings->robot.body[0].low, Eigen::Vector3d(-0.5, 0, 0));
  EXPECT_EQ(settings->robot.body[0].high, Eigen::Vector3d(0.5, 1, 1));
}

TEST(Settings, MistakesNameFileLineKeyAndWhatIsAccepted) {
  EXPECT_THAT(error_of("[lidar]\nport = 70000\n"),
              AllOf(HasSubstr("robot.toml:2: lidar.port"), HasSubstr("1 to 65535")));
  EXPECT_THAT(error_of("[lidar]\nport = 1.5\n"), HasSubstr("whole number, accepted is 1 to 65535"));
  EXPECT_THAT(error_of("[lidar]\nmodel = \"hdl64\"\n"),
              AllOf(HasSubstr("lidar.model"), HasSubstr("\"puck_lite\"")));
  EXPECT_THAT(error_of("[lidar]\ntranslation = [1, 2]\n"),
              HasSubstr("three numbers, [x, y, z], accepted is -100 to 100 m"));
  EXPECT_THAT(error_of("[robot]\nbody = [[0, 0, 0], [1, 1, 1]]\n"),
              AllOf(HasSubstr("robot.toml:2: robot.body"), HasSubstr("two corners")));
  EXPECT_THAT(error_of("[robot]\nbody = [[[0, 0, 0]]]\n"), HasSubstr("[[x, y, z], [x, y, z]]"));
  EXPECT_THAT(error_of("[robot]\nbody = [[[0, 0, 0], [1, 0, 1]]]\n"), HasSubstr("without inside"));
  EXPECT_THAT(error_of("[lidar]\n\nprot = 2368\n"),
              AllOf(HasSubstr("robot.toml:3"),
                    HasSubstr("lidar.prot is not a setting; the nearest is lidar.port")));
  EXPECT_THAT(error_of("[radar]\nx = 1\n"),
              HasSubstr("radar is not a setting; the nearest is lidar"));
  EXPECT_THAT(error_of("[wheel]\nx = 1\n"),
              AllOf(HasSubstr("wheel is not a setting; there are those of "),
                    HasSubstr(", encoder, "), Not(HasSubstr("nearest"))));
  EXPECT_THAT(error_of("lidar = 3\n"), HasSubstr("lidar is a table"));
  EXPECT_THAT(error_of("[lidar\n"), HasSubstr("robot.toml:1"));
  EXPECT_THAT(error_of("[lidar]\nmin_range = 31\n"), HasSubstr("below lidar.max_range"));
  EXPECT_THAT(error_of("[lidar]\nmax_range = nan\n"), HasSubstr("out of range"));
  EXPECT_THAT(error_of("[detect.sweep]\nground_inner = 5\n"),
              AllOf(HasSubstr("robot.toml:2"), HasSubstr("ground_outer")));
  EXPECT_THAT(error_of("[detect.map]\n\nleaf_size = 0.0001\n"),
              AllOf(HasSubstr("robot.toml:3"), HasSubstr("must be 0 or at least 0.001")));
  EXPECT_THAT(error_of("[detect]\nlists_per_turn = 3\n"),
              HasSubstr("robot.toml:2: detect.lists_per_turn must be 1, 2, 4 or 8"));
  EXPECT_THAT(error_of("[lidar]\nport = 1\nport = 2\n"),
              AllOf(HasSubstr("robot.toml:3"), HasSubstr("port")));
}

TEST(Settings, AllMistakesAreNamedAtOnceInTheOrderOfTheirLines) {
  EXPECT_EQ(error_of("[track]\nappear = 0.2\ndisappear = 0.3\n[lidar]\nprot = 1\nport = 0\n"
                     "[imu]\nrate = \"fast\"\n[radar]\n"),
            "robot.toml:3: track.disappear must not be above track.appear\n"
            "robot.toml:5: lidar.prot is not a setting; the nearest is lidar.port\n"
            "robot.toml:6: lidar.port = 0 is out of range, accepted is 1 to 65535\n"
            "robot.toml:8: imu.rate must be a whole number, accepted is 100 to 400 Hz\n"
            "robot.toml:9: radar is not a setting; the nearest is lidar");
  EXPECT_EQ(error_of("[lidar]\nprot = 1\nx\n").find('\n'), std::string::npos)
      << "what is no TOML has no keys";
}

TEST(Settings, KeysAreComparedByTheirPath) {
  EXPECT_THAT(error_of("\"lidar.port\" = 3368\n"),
              AllOf(HasSubstr("robot.toml:1: \"lidar.port\" is not a setting"),
                    HasSubstr("the nearest is lidar.port")));
  EXPECT_THAT(error_of("[detect]\n\"map.leaf_size\" = 0.2\n"),
              HasSubstr("robot.toml:2: detect.\"map.leaf_size\" is not a setting"));
  EXPECT_THAT(error_of("[lidar]\n\"port\\u0000x\" = 3368\n"),
              HasSubstr("robot.toml:2: lidar.\"port\\u0000x\" is not a setting"));
  EXPECT_THAT(error_of("[lidar]\n\"\" = 1\n"), HasSubstr("lidar.\"\" is not a setting"));
  EXPECT_EQ(error_of("[lidar]\n\"port\" = 3368\n"), "no error");
}

TEST(Settings, DepthAndLengthOfKeysAreBounded) {
  const auto times = [](std::size_t n, std::string_view text) {
    std::string all;
    for (std::size_t i = 0; i < n; ++i) all += text;
    return all;
  };
  EXPECT_THAT(error_of("[lidar]\n" + times(40000, "a.") + "a = 1\n"),
              HasSubstr("robot.toml:2: the line has 80005 characters, 1000 are the most"));
  EXPECT_THAT(error_of(std::string(200000, 'a') + " = 1"), HasSubstr("robot.toml:1: the line"));
  EXPECT_THAT(error_of(times(400, "a.") + "a = 1"), HasSubstr("a is not a setting"));
  EXPECT_THAT(error_of("x = [\n" + times(9, "{" + times(400, "a.") + "a = [\n")),
              HasSubstr("nested value depth"));
  EXPECT_THAT(error_of(times(100000, "[[a]]\nb = 1\n")), HasSubstr("a is not a setting"));
}

TEST(Settings, LettersBeyondAsciiStandInStringsAndRemarksOnly) {
  const auto accepts = [](const std::string& toml) {
    return parse_settings(toml, "robot.toml").has_value();
  };
  EXPECT_TRUE(accepts("\xEF\xBB\xBF# Gr\u00F6\u00DFe\n[imu]\ndevice = \"/dev/\u02A2\" # \u02A2\n"));
  EXPECT_TRUE(accepts("[imu]\ndevice = \"a\\\"\u02A2\"\n"));
  EXPECT_TRUE(accepts("[imu]\ndevice = '\\'\n[lidar]\nport = 1\n"));
  EXPECT_TRUE(accepts("[imu]\ndevice = \"\"\"\n\u02A2 # \"\"\"\n"));
  for (const char* outside : {"[imu]\nrate = \u02A2\n", "[imu]\n\u02A2 = 1\n", "[\u2003imu]\n",
                              "[imu]\ndevice = \"a\"\u02A2\n", "[imu]\n\nrate = 1\uFEFF\n"}) {
    const auto settings = parse_settings(outside, "robot.toml");
    ASSERT_FALSE(settings) << outside;
    EXPECT_THAT(settings.error().message, HasSubstr("not of ASCII")) << outside;
  }
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

TEST(Settings, AStopZoneThatTheLidarIsNotListenedToInIsAnError) {
  EXPECT_THAT(error_of("[lidar]\nmax_range = 1.5\n"), HasSubstr("ends before the stop zone"));
  EXPECT_THAT(error_of("[lidar]\nmin_range = 9\n"), HasSubstr("begins behind the stop zone"));
  EXPECT_THAT(error_of("[robot]\nbody = [[[0.2, -6, -3], [9, 6, 3]]]\n"),
              HasSubstr("covers the stop zone"));
  EXPECT_EQ(error_of("[robot]\nbody = [[[-1, -0.5, 0], [0.6, 0.5, 1]]]\n"), "no error");
  EXPECT_EQ(error_of("[lidar]\nmax_range = 1.5\n[stop]\nlength = 1\n"), "no error");
  EXPECT_EQ(error_of("[stop]\nlength = 0.1\n"), "no error") << "how one does without a zone";
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

constexpr std::array kShippedFiles = {kOwnersFile, kProfiles[0], kProfiles[1], kProfiles[2]};

/// A shipped file whose keys stand no longer as remarks, but for real.
std::string all_set(std::string_view file) {
  std::istringstream lines{default_toml(file)};
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const bool is_key = line.starts_with("#") && !line.starts_with("# ");
    text += line.substr(is_key ? 1 : 0) + "\n";
  }
  return text;
}

TEST(Settings, DefaultFilesReadBackToTheDefaults) {
  for (const std::string_view file : kShippedFiles) {
    const auto settings = parse_settings(all_set(file), std::string(file));
    ASSERT_TRUE(settings) << settings.error().message;
    EXPECT_EQ(toml_values(*settings), toml_values(Settings()));
  }
}

TEST(Settings, EachKeyStandsInOneShippedFile) {
  std::multiset<std::string> written, keys;
  for (const std::string_view file : kShippedFiles) {
    std::istringstream lines{all_set(file)};
    std::string table;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("[")) table = line.substr(1, line.size() - 2);
      if (line.empty() || line.starts_with("#") || line.starts_with("[")) continue;
      written.insert(table + "." + line.substr(0, line.find(' ')));
    }
  }
  const Settings defaults;
  for_each_key(defaults, [&](const Key& key, const auto&) { keys.insert(full_name(key)); });
  EXPECT_EQ(written, keys);
}

TEST(Settings, ShippedPaperFileIsThePapersMethod) {
  const auto settings = load_settings(std::string(SCREE_SOURCE) + "/config/paper.toml");
  ASSERT_TRUE(settings) << settings.error().message;
  Settings paper;
  paper.detect_cloud = DetectSettings::for_paper();
  EXPECT_EQ(toml_values(*settings), toml_values(paper));
}

TEST(Settings, TheDropInForSmallComputersIsCoarser) {
  const auto settings = load_settings(std::string(SCREE_SOURCE) + "/config/small.toml");
  ASSERT_TRUE(settings) << settings.error().message;
  const Settings defaults;
  EXPECT_GT(settings->map.voxel, defaults.map.voxel);
  EXPECT_GT(settings->detect_map.surface.ground_cell, defaults.detect_map.surface.ground_cell);
  EXPECT_LT(settings->memory.map_voxels, defaults.memory.map_voxels);
  EXPECT_GE(settings->map.search_reach, settings->track.reach);
}

/// The shipped files are these very texts; SCREE_UPDATE=1 in the environment writes them anew.
TEST(Settings, ShippedFilesAreTheDefaults) {
  for (const std::string_view file : kShippedFiles) {
    const std::string shipped = fmt::format("{}/config/{}", SCREE_SOURCE, file);
    if (std::getenv("SCREE_UPDATE") != nullptr) std::ofstream(shipped) << default_toml(file);
    std::ostringstream text;
    text << std::ifstream(shipped).rdbuf();
    EXPECT_EQ(text.str(), default_toml(file));
  }
}

TEST(Settings, AKeyOfAnotherMethodIsAnErrorThatSaysSo) {
  EXPECT_THAT(error_of("[detect.cloud]\nedge_threshold = 0.3\n"),
              HasSubstr(":2: detect.cloud.edge_threshold is read only with method = \"edges\""));
  EXPECT_THAT(error_of("[detect.cloud]\ncluster_method = \"euclidean\"\nsaddle = 0.3\n"),
              HasSubstr("detect.cloud.saddle is read only with cluster_method = \"regions\""));
  EXPECT_THAT(error_of("[detect.sweep]\nsuppression_radius = 0.3\n"),
              HasSubstr("is read only with suppression = true"));
  EXPECT_THAT(error_of("[detect.map]\ncluster_method = \"supervoxel\"\n"),
              HasSubstr("must be one of \"regions\", \"euclidean\""));
  EXPECT_EQ(error_of("[detect.cloud]\nsaddle = 0.3\ncluster_method = \"regions\"\n"), "no error");
  EXPECT_EQ(error_of("[detect.cloud]\nmethod = \"edges\"\nedge_threshold = 0.3\n"), "no error");
  const auto settings =
      parse_settings("[detect.cloud]\nkernel_spacing = 0.3\nmethod = \"edges\"\n", "robot.toml");
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->detect_cloud.edges.kernel.spacing, 0.3);
  EXPECT_EQ(settings->detect_cloud.surface.kernel.spacing, 0.1) << "of a name that both have";
}

TEST(Settings, AKeyThatIsGoneNamesWhatReplacesIt) {
  const auto expect = [](const std::string& toml, const char* instead) {
    EXPECT_THAT(error_of(toml), AllOf(HasSubstr("is gone"), HasSubstr(instead))) << toml;
  };
  expect("[map]\nmax_voxels = 1\n", "memory.map_voxels");
  expect("[map]\nmax_points = 1\n", "memory.sweep_points");
  expect("[detect.cloud]\nmax_points = 1\n", "memory.cloud_points");
  for (const std::string table : {"[detect.cloud]", "[detect.map]", "[detect.sweep]"}) {
    expect(table + "\nmax_edge_points = 1\n", "[memory]");
    expect(table + "\nmax_obstacles = 1\n", "memory.obstacles");
    expect(table + "\nmax_ground_cells = 1\n", "memory.ground_cells");
    expect(table + "\nvoxel_grid = false\n", "leaf_size = 0");
    expect(table + "\nground = \"ring\"\n", "method = \"edges\"");
    expect(table + "\ncandidates = \"bodies\"\n", "method = \"surface\"");
  }
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
