#include "scree/detect/ground_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "detect/clouds.hpp"

namespace scree {
namespace {

constexpr std::size_t kMaxPoints = 60'000, kMaxCells = 1 << 15;

/// 8 x 8 m of this shape, seen evenly, with noise of 5 mm.
PointCloud seen(const std::function<float(float, float)>& height, std::size_t points = 30'000) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-4, 4);
  std::normal_distribution<float> noise(0, 0.005F);
  PointCloud cloud(points);
  while (cloud.size() < points) {
    const float x = place(random), y = place(random);
    cloud.push_back(x, y, height(x, y) + noise(random), 0);
  }
  return cloud;
}

bool is_ground(const GroundSurface& surface, float x, float y) {
  return surface.is_ground(surface.cell_at(x, y));
}

/// Without the trend, and with it.
class GroundSurfaceTest : public testing::TestWithParam<float> {
protected:
  static GroundSurfaceSettings settings_for_test() {
    GroundSurfaceSettings settings = test::kGroundSettings;
    settings.finder.trend_reach = GetParam();
    return settings;
  }
  static GroundSurface surface_of(PointView cloud) {
    GroundSurface surface(settings_for_test(), kMaxPoints, kMaxCells);
    surface.build(cloud);
    return surface;
  }
};
INSTANTIATE_TEST_SUITE_P(Trend, GroundSurfaceTest, testing::Values(0.0F, 2.0F));

float slope(float x) {
  return 0.25F * x;
}

TEST_P(GroundSurfaceTest, FollowsASlope) {
  const GroundSurface surface = surface_of(seen([](float x, float) { return slope(x); }));
  for (float x = -3.5F; x < 3.6F; x += 0.5F) {
    EXPECT_TRUE(is_ground(surface, x, 1)) << x;
    EXPECT_NEAR(surface.height(x, 1), slope(x), 0.015) << x;
  }
}

TEST_P(GroundSurfaceTest, SpansRocksAndHolesWithTheSlopeAroundThem) {
  for (const float height : {0.2F, 1.2F, -0.2F, -1.0F}) {
    for (const float half_width : {0.15F, 0.5F, 1.0F}) {
      const GroundSurface surface = surface_of(seen([&](float x, float y) {
        return slope(x) + (test::in_square(x, y, half_width) ? height : 0.0F);
      }));
      EXPECT_NEAR(surface.height(0, 0), 0, 0.04) << height << ' ' << half_width;
      EXPECT_FALSE(is_ground(surface, 0, 0)) << height << ' ' << half_width;
      EXPECT_TRUE(is_ground(surface, half_width + 0.4F, 0)) << height << ' ' << half_width;
    }
  }
}

TEST_P(GroundSurfaceTest, IsNotRaisedBetweenTwoTallRocks) {
  const GroundSurface surface = surface_of(seen([](float x, float y) {
    return test::in_square(std::abs(x) - 0.65F, y, 0.5F) ? 1.0F : 0.0F;
  }));
  EXPECT_NEAR(surface.height(0, 0), 0, 0.03);
  EXPECT_TRUE(is_ground(surface, 0, 0));
}

TEST_P(GroundSurfaceTest, FollowsASmoothHollowDownToThePotholeInIt) {
  const GroundSurface surface = surface_of(seen([](float x, float y) {
    const float share = std::min(std::hypot(x, y) / 2.5F, 1.0F);
    const float hollow = -0.2F * (1 + std::cos(3.14159F * share));
    return hollow - (test::in_square(x, y, 0.2F) ? 0.3F : 0.0F);
  }));
  EXPECT_NEAR(surface.height(0, 0), -0.4, 0.03);
  EXPECT_NEAR(surface.height(1.25F, 0), -0.2, 0.02);
  EXPECT_TRUE(is_ground(surface, 0.6F, 0));
  EXPECT_FALSE(is_ground(surface, 0, 0));
}

TEST_P(GroundSurfaceTest, GoesOnBelowTheGrassThatSurroundsAHollow) {
  const auto hollow = [](float x, float y) {
    return -0.2F * (1 + std::cos(3.14159F * std::min(std::hypot(x, y) / 2.5F, 1.0F)));
  };
  const auto is_grass = [](float x, float y) { return std::abs(std::hypot(x, y) - 1.5F) < 0.4F; };
  std::mt19937 random(5);
  std::uniform_real_distribution<float> blade(0, 0.5F);
  const PointCloud cloud = seen(
      [&](float x, float y) {
        return hollow(x, y) + (is_grass(x, y) ? std::max(blade(random) - 0.25F, 0.0F) : 0.0F);
      },
      50'000);
  GroundSurface surface = surface_of(cloud);
  EXPECT_GT(surface.height(0, 0), -0.25) << "without being told where grass is";
  std::vector<std::uint8_t> loose(surface.columns() * surface.rows(), 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float x = cloud.x[i], y = cloud.y[i];
    if (is_grass(x, y)) loose[surface.cell_at(x, y)] = 1;
  }
  surface.build_below(loose);
  for (float x = -3; x < 3.1F; x += 0.25F) {
    EXPECT_NEAR(surface.height(x, 0), hollow(x, 0), 0.03) << x;
  }
  EXPECT_TRUE(is_ground(surface, 0, 0));
}

TEST_P(GroundSurfaceTest, IsAsGoodAsWantedWhereItIsRough) {
  const PointCloud cloud = seen([](float x, float y) {
    return slope(x) + (test::in_square(x, y, 0.4F) ? 0.5F : 0.0F) -
           (test::in_square(x - 2, y, 0.4F) ? 0.4F : 0.0F);
  });
  GroundSurface surface(settings_for_test(), kMaxPoints, kMaxCells);
  surface.build_roughly(cloud, bounds_of(cloud));
  std::vector<float> heights(cloud.size());
  surface.heights_above(cloud, heights);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float x = cloud.x[i], y = cloud.y[i];
    // A slope ends with the raster.
    if (test::in_square(x, y, 3.7F)) {
      EXPECT_NEAR(surface.height(x, y), slope(x), 0.06);
    }
    EXPECT_NEAR(heights[i], cloud.z[i] - surface.height(x, y), 1e-5);
  }
  const std::vector<std::uint8_t> none_is_loose(surface.columns() * surface.rows(), 0);
  surface.build_below(none_is_loose);
  const GroundSurface at_once = surface_of(cloud);
  for (std::size_t cell = 0; cell < none_is_loose.size(); ++cell) {
    EXPECT_EQ(surface.level(cell), at_once.level(cell));
  }
}

TEST_P(GroundSurfaceTest, IsNotMovedBySinglePointsThatBelongToNothing) {
  PointCloud cloud = seen([](float, float) { return 0.0F; });
  for (std::size_t i = 0; i < cloud.size(); i += 1500) cloud.z[i] += i % 2 == 0 ? 1.0F : -0.5F;
  const GroundSurface surface = surface_of(cloud);
  for (std::size_t i = 0; i < cloud.size(); i += 1500) {
    EXPECT_NEAR(surface.height(cloud.x[i], cloud.y[i]), 0, 0.03);
  }
}

TEST_P(GroundSurfaceTest, TakesLargerCellsWhereTheCloudIsSparseOrWide) {
  const auto flat = [](float, float) { return 0.0F; };
  EXPECT_EQ(surface_of(seen(flat, 60'000)).cell_size(), test::kGroundSettings.cell_size);
  const GroundSurface sparse = surface_of(seen(flat, 3'000));
  EXPECT_GT(sparse.cell_size(), 1.5F * test::kGroundSettings.cell_size);
  EXPECT_TRUE(is_ground(sparse, 1, 1));

  PointCloud wide = seen(flat);
  for (float& x : wide.x) x *= 100;
  const GroundSurface coarse = surface_of(wide);
  EXPECT_LE(coarse.columns() * coarse.rows(), kMaxCells);
  EXPECT_NEAR(coarse.height(300, 0), 0, 0.02);
}

TEST_P(GroundSurfaceTest, AnswersForCloudsOfNothingAndFarOutside) {
  PointCloud cloud(100);
  EXPECT_EQ(surface_of(cloud).height(1, 2), 0);
  cloud.push_back(5, 6, 7, 0);
  EXPECT_TRUE(std::isfinite(surface_of(cloud).height(-1e6F, 1e6F)));
  while (cloud.push_back(5, 6, 7, 0)) {
  }
  const GroundSurface one_place = surface_of(cloud);
  EXPECT_EQ(one_place.points_in(one_place.cell_at(5, 6)), 100U);
}

TEST_P(GroundSurfaceTest, HeightsAboveItAreThoseOfTheSinglePlaces) {
  const GroundSurface surface = surface_of(seen([](float x, float) { return slope(x); }));
  std::mt19937 random(4);
  std::uniform_real_distribution<float> place(-6, 6);  // some beyond the raster
  PointCloud points(1000);
  while (points.size() < 1000) points.push_back(place(random), place(random), place(random), 0);
  points.x[17] = std::numeric_limits<float>::quiet_NaN();
  std::size_t next = 0;
  surface.for_each_height(points, [&](std::size_t i, float height) {
    ASSERT_EQ(i, next++);
    if (i == 17) return;
    ASSERT_NEAR(height, points.z[i] - surface.height(points.x[i], points.y[i]), 1e-5);
  });
  EXPECT_EQ(next, points.size());
}

TEST(GroundSurface, BeyondADitchTiltedGroundGoesOn) {
  PointCloud cloud = seen(
      [](float x, float y) { return 0.06F * y + (std::abs(y) < 1.2F ? -0.7F : 0.0F) + 0.0F * x; });
  GroundSurface surface(test::kGroundSettings, kMaxPoints, kMaxCells);
  surface.build(cloud);
  for (const float y : {-3.0F, -1.8F, 1.8F, 3.0F}) {
    EXPECT_TRUE(is_ground(surface, 1, y)) << y;
    EXPECT_NEAR(surface.height(1, y), 0.06F * y, 0.02) << y;
  }
  EXPECT_FALSE(is_ground(surface, 1, 0)) << "the ditch";
}

TEST(GroundSurface, OfSmallPatchesTheLowestIsGround) {
  // Leaves that lie level above a clearing that is hardly smaller.
  PointCloud cloud = seen([](float x, float y) {
    const bool is_leaf = x > 0 && x < 1.5F && std::abs(y) < 0.6F;
    const bool is_clearing = x > -1.6F && x < -0.2F && std::abs(y) < 0.6F;
    const auto bush = static_cast<float>(
        (static_cast<int>((x + 4) * 9) * 7 + static_cast<int>((y + 4) * 9) * 5) % 8);
    return is_leaf ? 1.0F : is_clearing ? 0.0F : 0.3F + 0.2F * bush;
  });
  GroundSurface surface(test::kGroundSettings, kMaxPoints, kMaxCells);
  surface.build(cloud);
  EXPECT_TRUE(is_ground(surface, -0.9F, 0));
  EXPECT_FALSE(is_ground(surface, 0.8F, 0));
}

TEST(GroundSurface, TheTrendGoesOnWithASlopeFromRingToRing) {
  std::mt19937 random(3);
  std::normal_distribution<float> wide(0, 0.06F), noise(0, 0.005F);
  PointCloud cloud(kMaxPoints);
  const auto see = [&](float x, float y) {
    const float rock = std::hypot(x - 4.5F, y) < 0.4F ? 0.5F : 0.0F;
    cloud.push_back(x, y, slope(x) + rock + noise(random), 0);
  };
  for (const float radius : {2.5F, 3.0F, 3.6F, 4.5F, 6.0F, 8.2F}) {
    for (int i = 0; i < 3000; ++i) {
      const float angle = static_cast<float>(i) * 0.0021F;
      const float away = radius + wide(random);
      see(away * std::cos(angle), away * std::sin(angle));
    }
  }
  GroundSurfaceSettings settings = test::kGroundSettings;
  settings.finder.trend_reach = 2;
  GroundSurface surface(settings, kMaxPoints, kMaxCells);
  surface.build(cloud);
  EXPECT_NEAR(surface.height(4.5F, 0), slope(4.5F), 0.06);
  EXPECT_NEAR(surface.height(-7, 0), slope(-7), 0.06);
  EXPECT_NEAR(surface.height(7, 0), slope(7), 0.06);
  for (const float radius : {2.5F, 4.5F, 6.0F, 8.2F}) {
    EXPECT_NEAR(surface.height(-radius, 0), slope(-radius), 0.03) << radius;
    EXPECT_NEAR(surface.height(0, radius), 0, 0.03) << radius;
  }
}

TEST(RasterFill, SpansAHoleInAPlaneWithThePlane) {
  for (const std::size_t side : {7U, 16U, 33U}) {
    const auto plane = [](std::size_t column, std::size_t row) {
      return 0.3F * static_cast<float>(column) - 0.1F * static_cast<float>(row);
    };
    std::vector<float> heights(side * side, 99);
    std::vector<std::uint8_t> known(side * side, 0);
    for (std::size_t row = 0; row < side; ++row) {
      for (std::size_t column = 0; column < side; ++column) {
        const bool is_inside = std::min(row, column) >= 2 && std::max(row, column) + 2 < side;
        if (is_inside) continue;
        known[row * side + column] = 1;
        heights[row * side + column] = plane(column, row);
      }
    }
    RasterFill fill(side * side);
    fill.fill(side, side, known.data(), heights.data());
    const float range = 0.4F * static_cast<float>(side);
    for (std::size_t row = 0; row < side; ++row) {
      for (std::size_t column = 0; column < side; ++column) {
        EXPECT_NEAR(heights[row * side + column], plane(column, row), 0.02 * range) << side;
      }
    }
  }
}

TEST(RasterFill, KeepsWhatIsKnownAndFillsAnyShape) {
  for (const auto& [columns, rows] : {std::pair{1U, 1U}, {1U, 9U}, {5U, 1U}, {3U, 8U}}) {
    RasterFill fill(columns * rows);
    std::vector<float> heights(columns * rows, 7);
    std::vector<std::uint8_t> known(columns * rows, 0);
    fill.fill(columns, rows, known.data(), heights.data());
    EXPECT_EQ(heights, std::vector<float>(columns * rows, 0));
    known.back() = 1;
    heights.back() = 4;
    fill.fill(columns, rows, known.data(), heights.data());
    EXPECT_EQ(heights.back(), 4);
    EXPECT_NEAR(heights.front(), 4, 1e-5);
  }
}

}  // namespace
}  // namespace scree
