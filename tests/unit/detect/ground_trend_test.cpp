#include "scree/detect/ground_trend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "allocation_counter.hpp"

namespace scree {
namespace {

constexpr float kCell = 0.1F, kReach = 2;
constexpr std::size_t kSide = 240;

float place(std::size_t index) {
  return (static_cast<float>(index) + 0.5F - kSide / 2.0F) * kCell;
}

std::vector<float> trend_of(GroundTrend& trend, std::size_t cells) {
  std::vector<float> heights(cells, 0);
  trend.add_to(heights.data(), 1);
  return heights;
}

/// A raster of 24 x 24 m around a robot that stands still: the rings of a lidar on ground of this
/// shape.
class Rings {
public:
  explicit Rings(const std::function<float(float, float)>& ground)
      : known_(kSide * kSide), heights_(kSide * kSide, NAN) {
    for (const float radius : {2.5F, 3.0F, 3.6F, 4.5F, 6.0F, 8.2F, 11.0F}) {
      for (std::size_t row = 0; row < kSide; ++row) {
        for (std::size_t column = 0; column < kSide; ++column) {
          const float away = std::hypot(place(column), place(row));
          if (std::abs(away - radius) > 0.1F) continue;
          known_[row * kSide + column] = 1;
          heights_[row * kSide + column] = ground(place(column), place(row));
        }
      }
    }
    fitted_.fit(kSide, kSide, known_.data(), heights_.data(), kCell, kReach);
    trend_ = trend_of(fitted_, kSide * kSide);
  }

  float trend(float x, float y) const {
    const auto index = [](float p) { return static_cast<std::size_t>(p / kCell + kSide / 2.0F); };
    return trend_[index(y) * kSide + index(x)];
  }
  /// The largest distance of the trend from the ground within the rings.
  float error(const std::function<float(float, float)>& ground) const {
    float largest = 0;
    for (float x = -5.5F; x < 5.6F; x += 0.5F) {
      for (float y = -5.5F; y < 5.6F; y += 0.5F) {
        largest = std::max(largest, std::abs(trend(x, y) - ground(x, y)));
      }
    }
    return largest;
  }
  GroundTrend& fitted() { return fitted_; }

private:
  std::vector<std::uint8_t> known_;
  std::vector<float> heights_;
  GroundTrend fitted_{kSide * kSide};
  std::vector<float> trend_;
};

float incline(float x, float y) {
  return 0.25F * x - 0.1F * y + 3;
}

TEST(GroundTrend, GoesOnWithASlopeBetweenTheRings) {
  EXPECT_LT(Rings(incline).error(incline), 0.03F);
}

TEST(GroundTrend, FollowsHills) {
  const auto hills = [](float x, float y) { return 0.5F * std::sin(x / 3) * std::cos(y / 4); };
  EXPECT_LT(Rings(hills).error(hills), 0.3F);
}

TEST(GroundTrend, WhatStandsOnTheGroundOrLiesBelowItHardlyMovesIt) {
  const auto littered = [](float x, float y) {
    const bool rock = std::hypot(x - 3, y - 1) < 0.8F, hole = std::hypot(x + 4, y + 3) < 1.2F;
    return incline(x, y) + (rock ? 0.8F : hole ? -0.7F : 0.0F);
  };
  EXPECT_LT(Rings(littered).error(incline), 0.08F);
}

TEST(GroundTrend, AnswersWhereLittleOrNothingIsKnown) {
  std::vector<std::uint8_t> known(kSide * kSide, 0);
  std::vector<float> heights(kSide * kSide, NAN);
  GroundTrend trend(kSide * kSide);
  trend.fit(kSide, kSide, known.data(), heights.data(), kCell, kReach);
  EXPECT_EQ(trend_of(trend, kSide * kSide)[200 * kSide + 7], 0);
  known[5 * kSide + 9] = 1;
  heights[5 * kSide + 9] = 1;
  trend.fit(kSide, kSide, known.data(), heights.data(), kCell, kReach);
  EXPECT_TRUE(std::isfinite(trend_of(trend, kSide * kSide)[7 * kSide + 200]));
  for (const auto& [columns, rows] :
       {std::pair<std::size_t, std::size_t>(1, 1), {1, 500}, {500, 1}}) {
    known.assign(kSide * kSide, 1);
    heights.assign(kSide * kSide, 2);
    trend.fit(columns, rows, known.data(), heights.data(), kCell, kReach);
    EXPECT_NEAR(trend_of(trend, columns * rows).back(), 2, 0.1) << columns << ' ' << rows;
  }
}

TEST(GroundTrend, AllocatesNothing) {
  Rings rings(incline);
  const std::vector<std::uint8_t> known(kSide * kSide, 1);
  const std::vector<float> heights(kSide * kSide, 1);
  const std::size_t before = test::allocations();
  rings.fitted().fit(kSide, kSide, known.data(), heights.data(), kCell, kReach);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
