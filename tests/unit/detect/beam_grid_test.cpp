#include "scree/detect/beam_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

namespace scree {
namespace {

constexpr std::size_t kPoints = 20'000, kCells = 1 << 12;
constexpr float kCell = 0.1F, kLowest = 0.06F, kHighest = 2;

/// Level ground with a rock and a branch high above it, and beams of any number at each point.
class BeamGridTest : public testing::Test {
protected:
  BeamGridTest() {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-2, 2);
    std::uniform_int_distribution<int> count(0, 50);
    while (cloud_.size() < kPoints) {
      const float x = place(random), y = place(random);
      float z = std::hypot(x, y) < 0.5F ? 0.3F : 0.0F;
      if (x > 1.5F && y > 1.5F) z = 2.5F;
      cloud_.push_back(x, y, z, 0);
      const int ended = count(random), passed = count(random);
      beams_.push_back({static_cast<float>(ended), static_cast<float>(passed),
                        0.01F * static_cast<float>(ended % 7)});
    }
    surface_.build(cloud_);
  }

  std::size_t cells() const { return surface_.columns() * surface_.rows(); }
  std::size_t middle() const { return surface_.cell_at(0, 0); }

  PointCloud cloud_{kPoints};
  std::vector<BeamCount> beams_;
  GroundSurface surface_{{.cell_size = kCell,
                          .cell_points = 1,
                          .finder = {.max_slope = 0.34F, .tolerance = 0.1F, .trend_reach = 0}},
                         kPoints,
                         kCells};
  BeamGrid beam_grid_{kCells};
};

TEST_F(BeamGridTest, CountsWhatStandsOnTheGroundCellByCell) {
  beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
  std::vector<float> ended(cells()), passed(cells()), scatter(cells());
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (cloud_.z[i] != 0.3F) continue;
    ended[surface_.cell_at(cloud_.x[i], cloud_.y[i])] += beams_[i].ended;
    passed[surface_.cell_at(cloud_.x[i], cloud_.y[i])] += beams_[i].passed;
    scatter[surface_.cell_at(cloud_.x[i], cloud_.y[i])] += beams_[i].scatter;
  }
  int counted = 0;
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    ASSERT_EQ(beam_grid_.ended(cell), ended[cell]);
    ASSERT_EQ(beam_grid_.passed(cell), passed[cell]);
    ASSERT_EQ(beam_grid_.scatter(cell), scatter[cell]);
    if (ended[cell] == 0) {
      ASSERT_EQ(beam_grid_.ended_share_around(cell), 1) << "nothing stands there";
      continue;
    }
    ++counted;
    float near_ended = 0, near_passed = 0;
    const auto column = static_cast<int>(cell % surface_.columns());
    const auto row = static_cast<int>(cell / surface_.columns());
    for (std::size_t other = 0; other < cells(); ++other) {
      if (std::abs(static_cast<int>(other % surface_.columns()) - column) > 2) continue;
      if (std::abs(static_cast<int>(other / surface_.columns()) - row) > 2) continue;
      near_ended += ended[other];
      near_passed += passed[other];
    }
    ASSERT_FLOAT_EQ(beam_grid_.ended_share_around(cell),
                    (near_ended + 1) / (near_ended + near_passed + 1));
  }
  EXPECT_GT(counted, 60) << "cells of the rock";
}

TEST_F(BeamGridTest, CountsTheBeamsOfSolidPointsAndThoseAtAnyHeight) {
  const auto look_at = [&](BeamCount standing) {
    beams_.clear();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const float z = cloud_.z[i];
      beams_.push_back(z == 0.3F ? standing : z < 1 ? BeamCount{10, 0, 0.5F} : BeamCount{7, 0, 7});
    }
    beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
    return beam_grid_.solid(middle());
  };
  EXPECT_GT(look_at({100, 5, 1}), 0);
  EXPECT_EQ(beam_grid_.solid(middle()), beam_grid_.ended(middle()));
  EXPECT_EQ(look_at({100, 20, 1}), 0) << "beams went on";
  EXPECT_EQ(look_at({100, 0, 3}), 0) << "ranges scatter";
  EXPECT_EQ(beam_grid_.all_ended(middle()), beam_grid_.ended(middle()));
  EXPECT_EQ(beam_grid_.all_scatter(middle()), beam_grid_.scatter(middle()));

  const std::size_t ground = surface_.cell_at(1, 1), branch = surface_.cell_at(1.8F, 1.8F);
  EXPECT_GT(beam_grid_.all_ended(ground), 0);
  EXPECT_FLOAT_EQ(beam_grid_.all_scatter(ground) / beam_grid_.all_ended(ground), 0.05F);
  EXPECT_EQ(beam_grid_.ended(ground), 0);
  EXPECT_EQ(beam_grid_.all_ended(branch), 0) << "the robot passes under it";
}

TEST_F(BeamGridTest, WithoutBeamsAllIsSolid) {
  beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
  EXPECT_LT(beam_grid_.ended_share_around(middle()), 0.6);
  beam_grid_.build(cloud_, {}, surface_, kLowest, kHighest);
  EXPECT_EQ(beam_grid_.ended_share_around(middle()), 1);
  EXPECT_EQ(beam_grid_.ended_share(middle()), 1);
  EXPECT_EQ(beam_grid_.ended(middle()), 0);
  EXPECT_EQ(beam_grid_.all_ended(middle()), 0);
  EXPECT_EQ(beam_grid_.solid(middle()), 0);
}

TEST_F(BeamGridTest, AllIsStoppedWhereHardlyABeamWentOn) {
  const auto stops_all = [&](BeamCount each) {
    beams_.assign(cloud_.size(), each);
    beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
    return beam_grid_.stops_all(middle());
  };
  EXPECT_TRUE(stops_all({100, 0}));
  EXPECT_TRUE(stops_all({100, 3}));
  EXPECT_FALSE(stops_all({100, 10})) << "a dense tuft";
  EXPECT_FALSE(stops_all({0, 0})) << "no beam came to it";
  EXPECT_FALSE(beam_grid_.stops_all(surface_.cell_at(1, 1))) << "nothing stands there";
}

TEST_F(BeamGridTest, IsLooseWhereRangesScatterMuchForItsHeight) {
  const auto is_loose = [&](float scatter, float height) {
    beams_.clear();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      if (cloud_.z[i] > 0 && cloud_.z[i] < 2) cloud_.z[i] = height;
      beams_.push_back({100, 0, 100 * scatter});
    }
    beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
    EXPECT_NEAR(beam_grid_.highest(middle()), height, 1e-3);
    return beam_grid_.is_loose(middle());
  };
  EXPECT_FALSE(is_loose(0.01F, 0.1F)) << "a stone, seen with 2 cm of noise";
  EXPECT_TRUE(is_loose(0.04F, 0.2F)) << "grass";
  EXPECT_FALSE(is_loose(0.04F, 0.8F)) << "the edge of a post";
  EXPECT_FALSE(beam_grid_.is_loose(surface_.cell_at(1, 1))) << "nothing stands there";
  beam_grid_.build(cloud_, {}, surface_, kLowest, kHighest);
  EXPECT_FALSE(beam_grid_.is_loose(middle())) << "nothing is known of the beams";
  EXPECT_EQ(beam_grid_.highest(middle()), 0);
}

TEST_F(BeamGridTest, AFewCellsAreAsLooseAsThoseAroundThem) {
  // Of the cell that lies so many columns and rows from the middle one.
  const auto cell_at = [&](int column, int row) {
    return middle() + static_cast<std::size_t>(row * static_cast<int>(surface_.columns()) + column);
  };
  const auto look_at = [&](float base, float other, auto&& is_other) {
    std::vector<float> scatter(cells(), base);
    for (int row = -3; row <= 3; ++row) {
      for (int column = -3; column <= 3; ++column) {
        if (is_other(column, row)) scatter[cell_at(column, row)] = other;
      }
    }
    beams_.clear();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      beams_.push_back({100, 0, 100 * scatter[surface_.cell_at(cloud_.x[i], cloud_.y[i])]});
    }
    beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
    return beam_grid_.is_loose(middle());
  };
  const auto is_within = [](int reach) {
    return [reach](int x, int y) { return std::max(std::abs(x), std::abs(y)) <= reach; };
  };
  EXPECT_FALSE(look_at(0.01F, 0.2F, is_within(0))) << "one scattered cell in a rock";
  EXPECT_TRUE(look_at(0.01F, 0.2F, is_within(2))) << "a tuft on a rock";
  EXPECT_TRUE(look_at(0.1F, 0, is_within(1))) << "a firm spot in a tuft";
  EXPECT_FALSE(look_at(0.1F, 0, is_within(2))) << "a stone in a tuft";
}

TEST_F(BeamGridTest, WhatIsLooseCanBeFoundAlone) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> scatter(0, 0.08F);
  for (BeamCount& beams : beams_) beams.scatter = beams.ended * scatter(random);
  BeamGrid whole(kCells);
  whole.build(cloud_, beams_, surface_, kLowest, kHighest);
  beam_grid_.find_loose(cloud_, beams_, surface_, kLowest, kHighest);
  EXPECT_TRUE(std::ranges::equal(beam_grid_.loose(), whole.loose()));
  EXPECT_GT(std::ranges::count(whole.loose(), 1), 5);
}

TEST_F(BeamGridTest, AFewCellsThatStandAloneStayAsTheyAre) {
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (surface_.cell_at(cloud_.x[i], cloud_.y[i]) != middle()) cloud_.z[i] = 0;
  }
  for (const float scatter : {0.01F, 0.1F}) {
    beams_.assign(cloud_.size(), {100, 0, 100 * scatter});
    beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
    EXPECT_EQ(beam_grid_.is_loose(middle()), scatter > 0.05F);
  }
}

TEST_F(BeamGridTest, TakesPointsThatAreNoNumbers) {
  beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
  const auto total = [&] {
    float sum = 0;
    for (std::size_t cell = 0; cell < cells(); ++cell) sum += beam_grid_.ended(cell);
    return sum;
  };
  const float before = total();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<std::size_t> rock;
  for (std::size_t i = 0; rock.size() < 3; ++i) {
    if (cloud_.z[i] == 0.3F) rock.push_back(i);
  }
  cloud_.x[rock[0]] = kNan;
  cloud_.y[rock[1]] = -kInfinity;
  cloud_.z[rock[2]] = kNan;
  beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
  EXPECT_EQ(total(), before - static_cast<float>(beams_[rock[0]].ended + beams_[rock[1]].ended +
                                                 beams_[rock[2]].ended));
}

TEST_F(BeamGridTest, PointsThatFoundNoRoomMayLieBeyondTheRaster) {
  PointCloud few(100);
  for (std::size_t i = 0; i < few.capacity(); ++i) {
    few.push_back(0.1F * static_cast<float>(i % 10), 0.1F * static_cast<float>(i / 10), 0, 0);
  }
  surface_.build(few);
  beam_grid_.build(cloud_, beams_, surface_, kLowest, kHighest);
  for (std::size_t cell = 0; cell < cells(); ++cell) {
    if (!surface_.has_neighbours(cell)) {
      EXPECT_EQ(beam_grid_.ended(cell), 0);
    }
  }
}

}  // namespace
}  // namespace scree
