#include "scoring/truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/temporary_folder.hpp"

namespace scree {
namespace {

using testing::HasSubstr;

const char* const kWhole =
    R"({"obstacles": [{"id": 1, "kind": "positive", "center": [1, 2, 0.2],
        "footprint": [[0, 0], [1, 0], [1, 1]], "height": 0.4, "shape": "rock"},
       {"id": 4, "kind": "negative", "center": [5, 2, -0.2],
        "footprint": [[4, 0], [5, 0], [5, 1]], "height": -0.4}],
       "poses": [{"t_ns": 10, "p": [0, 0, 0], "q": [1, 0, 0, 0]},
                 {"t_ns": 20, "p": [2, 0, 0], "q": [0.70710678, 0, 0, 0.70710678]}],
       "visible": [{"t_ns": 12, "ids": [1], "ignore": [4]}]})";

Result<Truth> read(const std::string& text) {
  const TemporaryFolder folder;
  return read_truth(folder.write("truth.json", text));
}

/// The whole file with one thing replaced.
std::string with(const std::string& old_part, const std::string& new_part) {
  std::string text = kWhole;
  const std::size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return text.replace(at, old_part.size(), new_part);
}

TEST(Truth, IsReadWhole) {
  const auto truth = read(kWhole);
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->obstacles.size(), 2U);
  EXPECT_EQ(truth->obstacles[0].shape, "rock");
  EXPECT_EQ(truth->obstacles[1].id, 4);
  EXPECT_EQ(truth->obstacles[1].kind, ObstacleKind::negative);
  EXPECT_EQ(truth->obstacles[1].height, -0.4);
  EXPECT_EQ(truth->obstacles[1].center, Eigen::Vector3d(5, 2, -0.2));
  EXPECT_EQ(truth->obstacles[1].footprint[2], Eigen::Vector2d(5, 1));
  ASSERT_EQ(truth->visible.size(), 1U);
  EXPECT_EQ(truth->visible[0].ids, std::vector{1});
  EXPECT_EQ(truth->visible[0].ignore, std::vector{4});
}

TEST(Truth, ReadsWhatItWrote) {
  const auto truth = read(kWhole);
  ASSERT_TRUE(truth);
  const TemporaryFolder folder;
  const auto file = folder / "truth.json";
  ASSERT_TRUE(write_truth(file, *truth));
  const auto again = read_truth(file);
  ASSERT_TRUE(again) << again.error().message;
  ASSERT_EQ(again->obstacles.size(), 2U);
  EXPECT_EQ(again->obstacles[0].footprint, truth->obstacles[0].footprint);
  EXPECT_EQ(again->obstacles[0].shape, "rock");
  EXPECT_EQ(again->poses[1].t_ns, 20);
  EXPECT_TRUE(again->poses[1].base.rotation.isApprox(truth->poses[1].base.rotation));
  EXPECT_EQ(again->visible[0].ignore, truth->visible[0].ignore);
}

TEST(Truth, PosesAreInterpolated) {
  const auto truth = read(kWhole);
  ASSERT_TRUE(truth);
  const Pose between = truth->pose_at(15);
  EXPECT_NEAR(between.translation.x(), 1, 1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(between.rotation).angle(), radians(45), 1e-6);
  EXPECT_EQ(truth->pose_at(10).translation.x(), 0);
  EXPECT_EQ(truth->pose_at(20).translation.x(), 2);
  EXPECT_EQ(truth->pose_at(-1000).translation.x(), 0);
  EXPECT_EQ(truth->pose_at(1000).translation.x(), 2);
}

TEST(Truth, ATrackMovesTheFootprint) {
  const auto truth = read(with("\"shape\"",
                               "\"track\": [[100, 1, 2, 0], [200, 3, 2, 3], "
                               "[300, 3, 4, -3]], \"shape\""));
  ASSERT_TRUE(truth) << truth.error().message;
  const TrueObstacle& walker = truth->obstacles[0];
  ASSERT_TRUE(walker.moves());
  EXPECT_FALSE(truth->obstacles[1].moves());
  EXPECT_EQ(walker.at(0).center, walker.center);
  EXPECT_EQ(walker.at(100).footprint, walker.footprint);
  const TrueObstacle half = walker.at(150);
  EXPECT_NEAR(half.center.x(), 2, 1e-9);
  EXPECT_EQ(half.center.z(), walker.center.z());
  // The corner (0, 0) lies 1 m behind and 2 m right of the place, and turns by 1.5 rad.
  EXPECT_NEAR(half.footprint[0].x(), 2 - std::cos(1.5) + 2 * std::sin(1.5), 1e-9);
  EXPECT_NEAR(half.footprint[0].y(), 2 - std::sin(1.5) - 2 * std::cos(1.5), 1e-9);
  // From 3 to -3 rad it turns the short way.
  EXPECT_NEAR(walker.at(250).footprint[0].x(), 3 + std::cos(0.0), 0.01);
  EXPECT_EQ(walker.at(400).center.y(), 4);
  const TemporaryFolder folder;
  ASSERT_TRUE(write_truth(folder / "again.json", *truth));
  const auto again = read_truth(folder / "again.json");
  ASSERT_TRUE(again);
  EXPECT_EQ(again->obstacles[0].track.size(), 3U);
  EXPECT_EQ(again->obstacles[0].at(250).center, walker.at(250).center);
}

TEST(Truth, ARefusalNamesFileAndPlace) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {with("0.4, \"shape\"", "null, \"shape\""), "obstacles[0].height: expected a number"},
      {with("0.4, \"shape\"", "NaN, \"shape\""), "parse error at line"},
      {with("0.4, \"shape\"", "1e999, \"shape\""), "number"},
      {with("[1, 2, 0.2]", "[1, 2]"), "obstacles[0].center: expected 3 items, found 2"},
      {with("[1, 2, 0.2]", "[1, 2, 1e30]"), "obstacles[0].center[2]: 1e+30 is out of range"},
      {with("[[0, 0], [1, 0], [1, 1]]", "[]"), "obstacles[0].footprint: it has no area"},
      {with("[[0, 0], [1, 0], [1, 1]]", "[[0, 0], [1, 1], [2, 2]]"), "has no area"},
      {with("[[0, 0], [1, 0], [1, 1]]", "[[0, 0], 7]"), "footprint[1]: expected an array"},
      {with("\"shape\"", "\"track\": [], \"shape\""), "obstacles[0].track: it has no place"},
      {with("\"shape\"", "\"track\": [[1, 2, 3]], \"shape\""), "track[0]: expected 4 items"},
      {with("\"shape\"", "\"track\": [[2, 0, 0, 0], [1, 0, 0, 0]], \"shape\""),
       "track[1][0]: 1 is before"},
      {with("\"positive\"", "\"upward\""), "obstacles[0].kind: unknown kind \"upward\""},
      {with("\"id\": 4", "\"id\": 1"), "obstacles[1].id: 1 stands twice"},
      {with("\"id\": 4", "\"id\": 4.5"), "obstacles[1].id: expected a whole number"},
      {with("\"id\": 4", "\"id\": 1e10"), "obstacles[1].id: expected a whole number"},
      {with("\"id\": 4", "\"id\": 99999999999999999999"), "obstacles[1].id"},
      {with("\"id\": 4", "\"id\": 18446744073709551615"), "obstacles[1].id"},
      {with("\"ids\": [1]", "\"ids\": [7]"), "visible[0].ids[0]: no obstacle has the id 7"},
      {with("\"ids\": [1]", "\"ids\": [1, 1]"), "visible[0].ids[1]: 1 stands twice"},
      {with("\"ignore\": [4]", "\"ignore\": [1]"), "visible[0].ignore[0]: 1 stands twice"},
      {with("\"t_ns\": 20", "\"t_ns\": 9"), "poses[1].t_ns: 9 is before"},
      {with("[1, 0, 0, 0]", "[0, 0, 0, 0]"), "poses[0].q: its length is 0"},
      {with("\"visible\"", "\"unseen\""), "\"visible\" is missing"},
      {R"({"obstacles": [], "poses": [], "visible": []})", "poses: there is none"},
      {R"({"obstacles": {}, "poses": [], "visible": []})", "obstacles: expected an array"},
      {"[]", "expected an object"},
      {"", "parse error at line 1"},
      {"\xff\xfe", "parse error"},
      {std::string(100'000, '['), "parse error"}};
  for (const auto& [text, reason] : cases) {
    const auto truth = read(text);
    ASSERT_FALSE(truth) << reason;
    EXPECT_THAT(truth.error().message, HasSubstr("truth.json: no truth: "));
    EXPECT_THAT(truth.error().message, HasSubstr(reason));
    EXPECT_THAT(truth.error().message, testing::Not(HasSubstr("\n")));
  }
}

TEST(Truth, EveryCutIsRefused) {
  const std::string whole = kWhole;
  for (std::size_t length = 0; length < whole.size(); length += 3) {
    EXPECT_FALSE(read(whole.substr(0, length))) << length;
  }
}

TEST(Truth, AMissingFileOrAFolderIsRefused) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_truth(folder / "none.json"));
  EXPECT_FALSE(read_truth(folder / ""));
}

}  // namespace
}  // namespace scree
