#include "scree/detect/planar_windows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace scree {
namespace {

constexpr std::size_t kWindowSide = 64;
constexpr float kWindowCell = 0.1F;

/// A raster of which one cell in `stride` is known along both axes.
template <class Height>
std::vector<float> sparse_raster(std::size_t stride, const Height& height) {
  std::vector<float> heights(kWindowSide * kWindowSide, std::nanf(""));
  for (std::size_t row = 0; row < kWindowSide; row += stride) {
    for (std::size_t column = 0; column < kWindowSide; column += stride) {
      heights[row * kWindowSide + column] =
          height(kWindowCell * static_cast<float>(column), kWindowCell * static_cast<float>(row));
    }
  }
  return heights;
}

std::size_t windows_in(const std::vector<float>& heights) {
  PlanarWindows windows(kWindowSide * kWindowSide);
  windows.find(kWindowSide, kWindowSide, heights.data(), kWindowCell, 0.34F);
  return windows.all().size();
}

TEST(PlanarWindows, FindTheSlopeOfASparseSlope) {
  const auto heights = sparse_raster(3, [](float x, float y) { return 0.2F * x - 0.1F * y; });
  PlanarWindows windows(kWindowSide * kWindowSide);
  windows.find(kWindowSide, kWindowSide, heights.data(), kWindowCell, 0.34F);
  ASSERT_GT(windows.all().size(), 10U);
  for (const PlanarWindow& window : windows.all()) {
    EXPECT_NEAR(window.rise_x / kWindowCell, 0.2, 0.01);
    EXPECT_NEAR(window.rise_y / kWindowCell, -0.1, 0.01);
    EXPECT_NEAR(window.plane_at(30, 30), 0.2 * 3 - 0.1 * 3, 0.02);
  }
}

TEST(PlanarWindows, AreNotFoundInLeaves) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> leaf(0, 1.5F);
  EXPECT_EQ(windows_in(sparse_raster(2, [&](float, float) { return leaf(random); })), 0U);
}

TEST(PlanarWindows, AreNotLaidOverAStone) {
  const auto stone = [](float x, float y) {
    return std::abs(x - 3.2F) < 0.25F && std::abs(y - 3.2F) < 0.25F ? 0.2F : 0.0F;
  };
  const auto heights = sparse_raster(1, stone);
  PlanarWindows windows(kWindowSide * kWindowSide);
  windows.find(kWindowSide, kWindowSide, heights.data(), kWindowCell, 0.34F);
  std::size_t over = 0;
  for (const PlanarWindow& window : windows.all()) {
    const bool holds_stone = window.column < 30 && window.column + window.columns > 34 &&
                             window.row < 30 && window.row + window.rows > 34;
    if (holds_stone && window.columns <= 16) ++over;
  }
  EXPECT_EQ(over, 0U);
}

TEST(PlanarWindows, OfASteepSlopeAreWideOnes) {
  const auto bank = sparse_raster(2, [](float x, float) { return 0.6F * x; });
  PlanarWindows windows(kWindowSide * kWindowSide);
  windows.find(kWindowSide, kWindowSide, bank.data(), kWindowCell, 0.34F);
  ASSERT_FALSE(windows.all().empty());
  for (const PlanarWindow& window : windows.all()) EXPECT_EQ(window.columns, 32U);
  EXPECT_EQ(windows_in(sparse_raster(2, [](float x, float) { return 0.9F * x; })), 0U);
}

TEST(PlanarWindows, OfOneRingAreNone) {
  std::vector<float> heights(kWindowSide * kWindowSide, std::nanf(""));
  for (std::size_t column = 0; column < kWindowSide; ++column)
    heights[20 * kWindowSide + column] = 0;
  EXPECT_EQ(windows_in(heights), 0U);
}

}  // namespace
}  // namespace scree
