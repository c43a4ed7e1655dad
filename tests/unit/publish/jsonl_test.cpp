#include "scree/publish/jsonl.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace scree {
namespace {

ObstacleList example() {
  ObstacleList list(4);
  list.stamp_ns = 1598601600123456789;
  list.pose.translation = {1.5, -0.25, 0};
  list.pose.rotation = {1, 0, 0, 0};
  Obstacle rock;
  rock.id = 7;
  rock.confidence = 0.98F;
  rock.center = {4.25, 1, 0.1};
  rock.extent = {0.5, 0.4, 0.42};
  rock.yaw = 0.3;
  rock.height = 0.42;
  rock.points = 118;
  Obstacle hole = rock;
  rock.velocity = {-0.5, 1.25};
  hole.id = 8;
  hole.kind = ObstacleKind::negative;
  hole.height = -1.0 / 3;
  list.obstacles.push_back(rock);
  list.obstacles.push_back(hole);
  return list;
}

TEST(Jsonl, WritesTheTextOfTheInterface) {
  std::string text;
  append_json_line(example(), text);
  EXPECT_EQ(
      text,
      "{\"stamp_ns\": 1598601600123456789, \"pose\": {\"p\": [1.5, -0.25, 0], "
      "\"q\": [1, 0, 0, 0]}, \"obstacles\": ["
      "{\"id\": 7, \"kind\": \"positive\", \"confidence\": 0.98, \"center\": [4.25, 1, 0.1], "
      "\"extent\": [0.5, 0.4, 0.42], \"yaw\": 0.3, \"height\": 0.42, \"velocity\": [-0.5, 1.25], "
      "\"points\": 118}, "
      "{\"id\": 8, \"kind\": \"negative\", \"confidence\": 0.98, \"center\": [4.25, 1, 0.1], "
      "\"extent\": [0.5, 0.4, 0.42], \"yaw\": 0.3, \"height\": -0.3333333333333333, "
      "\"velocity\": [0, 0], \"points\": 118}]}\n");
}

TEST(Jsonl, WritesAGridAsRunsOfStates) {
  ObstacleGrid grid;
  grid.stamp_ns = 1598601600123456789;
  grid.pose.translation = {1.5, -0.25, 0};
  grid.origin = {-0.4, 0.2};
  grid.cell_size = 0.2;
  grid.columns = 4;
  grid.rows = 3;
  const CellState unknown = CellState::unknown, free = CellState::free;
  for (const CellState state : {unknown, unknown, unknown, unknown,        //
                                unknown, free, free, CellState::occupied,  //
                                CellState::drop, CellState::drop, free, unknown}) {
    grid.state.push_back(state);
    const auto cell = static_cast<std::int16_t>(grid.ground.size());
    grid.ground.push_back(state == unknown ? ObstacleGrid::kNoGround
                                           : static_cast<std::int16_t>(cell - 7));
  }
  std::string text;
  append_json_line(grid, text);
  EXPECT_EQ(text,
            "{\"stamp_ns\": 1598601600123456789, \"pose\": {\"p\": [1.5, -0.25, 0], "
            "\"q\": [1, 0, 0, 0]}, \"origin\": [-0.4, 0.2], \"cell_size\": 0.2, \"columns\": 4, "
            "\"rows\": 3, \"states\": [\"4?\", \"?2.#\", \"2v.?\"], "
            "\"ground\": [-2, -1, 0, 1, 2, 3]}\n");
}

TEST(Jsonl, WritesEvidenceAndFootprintWhereThereAreAny) {
  ObstacleList list = example();
  list.obstacles[1].evidence = Evidence::wall;
  list.obstacles[1].footprint.push_back({4, 0.5});
  list.obstacles[1].footprint.push_back({5, 0.5});
  std::string text;
  append_json_line(list, text);
  EXPECT_NE(text.find("\"points\": 118, \"evidence\": \"wall\"}]}\n"), std::string::npos) << text;
  list.obstacles[1].footprint.push_back({4.5, 1.25});
  text.clear();
  append_json_line(list, text);
  EXPECT_NE(text.find("\"points\": 118}, {"), std::string::npos) << text;
  EXPECT_NE(text.find("\"points\": 118, \"evidence\": \"wall\", "
                      "\"footprint\": [[4, 0.5], [5, 0.5], [4.5, 1.25]]}]}\n"),
            std::string::npos)
      << text;
}

TEST(Jsonl, AnEmptyListIsStillALine) {
  std::string text = "before\n";
  append_json_line(ObstacleList(), text);
  EXPECT_EQ(text,
            "before\n{\"stamp_ns\": 0, \"pose\": {\"p\": [0, 0, 0], \"q\": [1, 0, 0, 0]}, "
            "\"obstacles\": []}\n");
}

TEST(Jsonl, NumbersThatAreNotFiniteAreNull) {
  ObstacleList list = example();
  list.obstacles[0].height = std::numeric_limits<double>::quiet_NaN();
  list.obstacles[0].center.x() = std::numeric_limits<double>::infinity();
  std::string text;
  append_json_line(list, text);
  EXPECT_NE(text.find("\"center\": [null, 1, 0.1]"), std::string::npos) << text;
  EXPECT_NE(text.find("\"height\": null"), std::string::npos) << text;
}

}  // namespace
}  // namespace scree
