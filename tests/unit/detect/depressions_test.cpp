#include "scree/detect/depressions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "allocation_counter.hpp"

namespace scree {
namespace {

constexpr std::size_t kRasterSide = 80;
constexpr float kRasterCell = 0.1F;

class DepressionsTest : public testing::Test {
protected:
  /// Cells that are taken from ground of this shape, x and y from its middle, metres.
  template <class Shape>
  std::vector<std::size_t> taken_from(const Shape& shape) {
    heights_.clear();
    for (std::size_t row = 0; row < kRasterSide; ++row) {
      for (std::size_t column = 0; column < kRasterSide; ++column) {
        heights_.push_back(shape(at(column), at(row)));
      }
    }
    ground_.assign(heights_.size(), 1);
    any_ = depressions_.remove({kRasterSide, kRasterSide, kRasterCell, heights_.data()}, ground_);
    std::vector<std::size_t> taken;
    for (std::size_t cell = 0; cell < ground_.size(); ++cell) {
      if (ground_[cell] == 0) taken.push_back(cell);
    }
    EXPECT_EQ(any_, !taken.empty());
    return taken;
  }

  static float at(std::size_t index) {
    return kRasterCell * (static_cast<float>(index) - kRasterSide / 2.0F);
  }

  Depressions depressions_{kRasterSide * kRasterSide};
  FixedVector<std::uint8_t> ground_{kRasterSide * kRasterSide};
  std::vector<float> heights_;
  bool any_ = false;
};

/// A round bowl, deepest in its middle.
float bowl(float x, float y, float depth, float radius) {
  const float share = std::min(std::hypot(x, y) / radius, 1.0F);
  return -depth * (1 - share * share);
}

TEST_F(DepressionsTest, ACraterIsTakenDownToItsRim) {
  const auto taken = taken_from([](float x, float y) { return bowl(x, y, 0.4F, 1.5F); });
  ASSERT_FALSE(taken.empty());
  for (std::size_t cell = 0; cell < heights_.size(); ++cell) {
    const bool is_taken = std::ranges::binary_search(taken, cell);
    EXPECT_EQ(is_taken, heights_[cell] < -0.06F) << cell;
  }
}

TEST_F(DepressionsTest, ARimThrownUpAroundItDoesNotHideIt) {
  const auto taken = taken_from([](float x, float y) {
    const float away = std::hypot(x, y) - 1.5F;
    return bowl(x, y, 0.3F, 1.5F) + 0.2F * std::exp(-away * away / 0.1F);
  });
  EXPECT_GT(taken.size(), 300U);
}

TEST_F(DepressionsTest, ShallowGentleAndOpenOnesStay) {
  EXPECT_TRUE(taken_from([](float x, float y) { return bowl(x, y, 0.18F, 0.9F); }).empty());
  EXPECT_TRUE(taken_from([](float x, float y) { return bowl(x, y, 0.4F, 3.5F); }).empty());
  EXPECT_TRUE(taken_from([](float x, float) { return 0.3F * x; }).empty()) << "a slope";
  EXPECT_TRUE(taken_from([](float, float y) { return std::abs(y) < 1 ? -0.5F : 0.0F; }).empty())
      << "a valley that leads out";
}

/// A round floor, with flanks of one slope around it up to the level.
float pan(float x, float y, float floor_radius, float slope, float width) {
  const float up = std::clamp(std::hypot(x, y) - floor_radius, 0.0F, width);
  return slope * (up - width);
}

TEST_F(DepressionsTest, GentleFlanksAroundAFloorMakeACraterUnlessItIsAValley) {
  EXPECT_FALSE(taken_from([](float x, float y) { return pan(x, y, 2, 0.27F, 0.8F); }).empty());
  EXPECT_TRUE(taken_from([](float x, float y) { return pan(x, y, 2, 0.17F, 1.3F); }).empty());
  EXPECT_TRUE(taken_from([](float x, float y) { return pan(x, y, 3.0F, 0.27F, 0.8F); }).empty())
      << "wider than a crater";
  EXPECT_TRUE(taken_from([](float x, float y) { return bowl(x, y, 0.4F, 3); }).empty())
      << "as steep, and without a floor";
}

TEST_F(DepressionsTest, WhatIsMostlyNotKnownStays) {
  taken_from([](float x, float y) { return bowl(x, y, 0.4F, 1.5F); });
  for (std::size_t cell = 0; cell < heights_.size(); ++cell) {
    ground_[cell] = heights_[cell] < -0.1F ? 0 : 1;
  }
  const std::size_t before = static_cast<std::size_t>(std::ranges::count(ground_, 0));
  depressions_.remove({kRasterSide, kRasterSide, kRasterCell, heights_.data()}, ground_);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(ground_, 0)), before);
}

TEST_F(DepressionsTest, AllocatesNothing) {
  taken_from([](float x, float y) { return bowl(x, y, 0.4F, 1.5F); });
  const std::size_t before = test::allocations();
  depressions_.remove({kRasterSide, kRasterSide, kRasterCell, heights_.data()}, ground_);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
