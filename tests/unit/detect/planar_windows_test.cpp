#include "scree/detect/planar_windows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace scree {
namespace {

constexpr std::size_t kSide = 64;
constexpr float kCell = 0.1F;

/// A raster of which one cell in `stride` is known along both axes.
template <class Height>
std::vector<float> raster(std::size_t stride, const Height& height) {
  std::vector<float> heights(kSide * kSide, std::nanf(""));
  for (std::size_t row = 0; row < kSide; row += stride) {
    for (std::size_t column = 0; column < kSide; column += stride) {
      heights[row * kSide + column] =
          height(kCell * static_cast<float>(column), kCell * static_cast<float>(row));
    }
  }
  return heights;
}

std::size_t count(const std::vector<float>& heights) {
  PlanarWindows windows(kSide * kSide);
  windows.find(kSide, kSide, heights.data(), kCell, 0.34F);
  return windows.all().size();
}

TEST(PlanarWindows, FindTheSlopeOfASparseSlope) {
  const auto heights = raster(3, [](float x, float y) { return 0.2F * x - 0.1F * y; });
  PlanarWindows windows(kSide * kSide);
  windows.find(kSide, kSide, heights.data(), kCell, 0.34F);
  ASSERT_GT(windows.all().size(), 10U);
  for (const PlanarWindow& window : windows.all()) {
    EXPECT_NEAR(window.rise_x / kCell, 0.2, 0.01);
    EXPECT_NEAR(window.rise_y / kCell, -0.1, 0.01);
    EXPECT_NEAR(window.plane_at(30, 30), 0.2 * 3 - 0.1 * 3, 0.02);
  }
}

TEST(PlanarWindows, AreNotFoundInLeaves) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> leaf(0, 1.5F);
  EXPECT_EQ(count(raster(2, [&](float, float) { return leaf(random); })), 0U);
}

TEST(PlanarWindows, AreNotLaidOverAStone) {
  const auto stone = [](float x, float y) {
    return std::abs(x - 3.2F) < 0.25F && std::abs(y - 3.2F) < 0.25F ? 0.2F : 0.0F;
  };
  const auto heights = raster(1, stone);
  PlanarWindows windows(kSide * kSide);
  windows.find(kSide, kSide, heights.data(), kCell, 0.34F);
  std::size_t over = 0;
  for (const PlanarWindow& window : windows.all()) {
    const bool holds_stone = window.column < 30 && window.column + window.columns > 34 &&
                             window.row < 30 && window.row + window.rows > 34;
    if (holds_stone && window.columns <= 16) ++over;
  }
  EXPECT_EQ(over, 0U);
}

TEST(PlanarWindows, OfASteepSlopeAreWideOnes) {
  const auto bank = raster(2, [](float x, float) { return 0.6F * x; });
  PlanarWindows windows(kSide * kSide);
  windows.find(kSide, kSide, bank.data(), kCell, 0.34F);
  ASSERT_FALSE(windows.all().empty());
  for (const PlanarWindow& window : windows.all()) EXPECT_EQ(window.columns, 32U);
  EXPECT_EQ(count(raster(2, [](float x, float) { return 0.9F * x; })), 0U);
}

TEST(PlanarWindows, OfOneRingAreNone) {
  std::vector<float> heights(kSide * kSide, std::nanf(""));
  for (std::size_t column = 0; column < kSide; ++column) heights[20 * kSide + column] = 0;
  EXPECT_EQ(count(heights), 0U);
}

}  // namespace
}  // namespace scree
