#include "live/top_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace scree::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// As it stands on a terminal. Pieces must lie inside and not on one another.
std::string text_of(const Page& page, int rows, int columns) {
  const auto width = static_cast<std::size_t>(columns);
  std::vector<std::string> lines(static_cast<std::size_t>(rows), std::string(width, '~'));
  for (const Piece& piece : page) {
    EXPECT_TRUE(piece.row >= 0 && piece.row < rows && piece.column >= 0) << piece.text;
    EXPECT_LE(static_cast<std::size_t>(piece.column) + piece.text.size(), width) << piece.text;
    std::string& line = lines.at(static_cast<std::size_t>(piece.row));
    for (std::size_t i = 0; i < piece.text.size(); ++i) {
      char& place = line.at(static_cast<std::size_t>(piece.column) + i);
      EXPECT_EQ(place, '~') << "two pieces: " << piece.text;
      place = piece.text[i];
    }
  }
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  std::ranges::replace(text, '~', ' ');
  return text;
}

Obstacle obstacle(std::int64_t id, ObstacleKind kind, double x, double y) {
  Obstacle one;
  one.id = id;
  one.kind = kind;
  one.confidence = 0.93F;
  one.center = {x, y, 0};
  one.extent = {1.25, 0.5, 0.4};
  one.height = kind == ObstacleKind::positive ? 0.42 : -0.31;
  return one;
}

TopView driving() {
  TopView view;
  view.url = "udpm://239.255.76.67:7667?ttl=0";
  health_t& health = view.health.emplace();
  health.stamp_ns = (12 * 3600 + 34 * 60 + 56) * 1'000'000'000LL;
  health.version = "0.1.0";
  health.state = health_t::OK;
  health.stop = 1;
  health.lidar.state = sensor_health_t::OK;
  health.lidar.source = "192.168.1.201";
  health.lidar.rate = 751;
  health.lidar.expected_rate = 754;
  health.lidar.lost = 3;
  health.lidar.refused_reason = {"size", "flags"};
  health.lidar.refused = {0, 7};
  health.lidar.clock = sensor_health_t::PPS_LOCKED;
  health.lidar.clock_offset_s = -12.5;
  health.imu.state = sensor_health_t::SILENT;
  health.latency = {100, 20, 40.25, 61.5};
  health.detector_time = {100, 10, 30, 50};
  health.stages = {{"map", {100, 2, 5, 6}}, {"gradient", {100, 4, 9, 11}}};
  health.queues = {{"sweeps", 1, 3, 3}, {"lists", 0, 1, 4}};
  health.threads = {{"detector", 17, 2}};
  health.processor_temperature = 48.25;
  health.sweeps_dropped = 8;
  health.position_deviation = 0.125;
  health.yaw_deviation = 0.25;
  ObstacleList& list = view.list.emplace(9);
  list.obstacles.push_back(obstacle(4, ObstacleKind::negative, 0, -6));
  list.obstacles.push_back(obstacle(7, ObstacleKind::positive, 3, 0));
  return view;
}

TEST(TopPage, ShowsHealthAndObstacles) {
  const std::string text = text_of(top_page(driving(), 30, 120), 30, 120);
  EXPECT_THAT(text, HasSubstr("screed 0.1.0  12:34:56  SEES  STOP"));
  EXPECT_THAT(text, HasSubstr("lidar   ok           751/754       3       7  PPS-locked       0.00"
                              "    -12.500  192.168.1.201"));
  EXPECT_THAT(text, HasSubstr("imu     silent"));
  EXPECT_THAT(text, HasSubstr("encoder off"));
  EXPECT_THAT(text, HasSubstr("latency          20.0   40.2    61.5"));
  EXPECT_LT(text.find("gradient"), text.find("  map")) << "the slowest first";
  EXPECT_THAT(text, HasSubstr("sweeps      1     3     3"));
  EXPECT_THAT(text, HasSubstr("detector        17      2"));
  EXPECT_THAT(text, HasSubstr("processor 48.2 C"));
  EXPECT_THAT(text, HasSubstr("pose    off by 0.12 m and 14.32 deg"));
  EXPECT_THAT(text, AllOf(HasSubstr("3 lidar lost"), HasSubstr("7 lidar refused for flags"),
                          HasSubstr("8 sweeps dropped")));
  const auto rock = text.find("7     rock    3.00    0 L   1.25 x 0.50     0.42     0.93");
  const auto hole = text.find("4     hole    6.00   90 R   1.25 x 0.50    -0.31     0.93");
  EXPECT_NE(rock, std::string::npos) << text;
  EXPECT_NE(hole, std::string::npos) << text;
  EXPECT_LT(rock, hole) << "the nearest first";
  EXPECT_THAT(text, AllOf(HasSubstr("^"), HasSubstr("#"), HasSubstr("O")));
}

TEST(TopPage, CallsAnEdgeByItsName) {
  TopView view = driving();
  view.list->obstacles[0].evidence = Evidence::edge;
  EXPECT_THAT(text_of(top_page(view, 30, 120), 30, 120), HasSubstr("4     edge    6.00   90 R"));
}

TEST(TopPage, CountsMalformedMessages) {
  TopView view = driving();
  view.refused = 3;
  EXPECT_THAT(text_of(top_page(view, 30, 120), 30, 120), HasSubstr("3 messages are malformed"));
}

TEST(TopPage, SaysWhenNobodyPublishes) {
  TopView view;
  view.url = "udpm://239.255.76.67:7667?ttl=0";
  view.waited = 4;
  EXPECT_THAT(text_of(top_page(view, 24, 80), 24, 80),
              AllOf(HasSubstr("no health yet for 4 s on udpm://239.255.76.67:7667"),
                    HasSubstr("does screed run")));
}

TEST(TopPage, SaysWhenHealthOrListsStop) {
  TopView view = driving();
  view.health_age = 3.2;
  view.list_age = 5;
  const std::string text = text_of(top_page(view, 24, 80), 24, 80);
  EXPECT_THAT(text, AllOf(HasSubstr("no health for 3 s"), HasSubstr("NO LIST for 5 s")));
  EXPECT_THAT(text, Not(HasSubstr("rock")));
}

TEST(TopPage, SaysWhyItIsBlindAndThatAnEmptyListIsNothing) {
  TopView view = driving();
  view.health->state = health_t::BLIND;
  view.health->reason = "no packets on UDP port 2368";
  view.list->obstacles.clear();
  const std::string text = text_of(top_page(view, 24, 80), 24, 80);
  EXPECT_THAT(text, AllOf(HasSubstr("BLIND  STOP"), HasSubstr("\nno packets on UDP port 2368"),
                          HasSubstr("nothing there")));
}

TEST(TopPage, WhatIsNotThereIsLeftOut) {
  TopView view = driving();
  view.health->position_deviation = std::numeric_limits<double>::quiet_NaN();
  view.health->processor_temperature = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(text_of(top_page(view, 30, 120), 30, 120),
              AllOf(Not(HasSubstr("processor")), Not(HasSubstr("pose"))));
}

TEST(TopPage, FitsEverySize) {
  TopView view = driving();
  for (std::int64_t id = 10; id < 17; ++id) {
    view.list->obstacles.push_back(
        obstacle(id, ObstacleKind::positive, static_cast<double>(id), 0));
  }
  for (int rows = 1; rows < 60; rows += 2) {
    for (int columns = 1; columns < 160; columns += 3)
      text_of(top_page(view, rows, columns), rows, columns);
  }
  EXPECT_THAT(text_of(top_page(view, 14, 80), 14, 80), HasSubstr("and 5 farther off"));
}

}  // namespace
}  // namespace scree::cli
