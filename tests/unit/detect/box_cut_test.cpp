#include "scree/detect/box_cut.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace scree {
namespace {

struct Cut {
  PointCloud points{400};
  std::vector<std::uint32_t> indices;

  BestCut best(float strip) {
    indices.resize(points.size());
    std::iota(indices.begin(), indices.end(), 0U);
    return best_cut(points, indices, smallest_box(points, indices), strip);
  }
};

TEST(BestCut, PartsTheArmsOfACorner) {
  Cut corner;
  for (int i = 0; i < 100; ++i) {
    const float way = 0.1F * static_cast<float>(i);
    corner.points.push_back(way, 0.2F, 0, 0);
    corner.points.push_back(0.2F, way, 0, 0);
  }
  const BestCut best = corner.best(0.5F);
  EXPECT_LT(best.area, 10);
  EXPECT_NE(best.cut.has_first(8, 0.2F), best.cut.has_first(0.2F, 8));
  EXPECT_EQ(corner.indices.size(), 200U);
}

TEST(BestCut, AStraightWallIsAsLargeInParts) {
  Cut wall;
  for (int i = 0; i < 100; ++i) wall.points.push_back(0.1F * static_cast<float>(i), 0, 0, 0);
  EXPECT_NEAR(wall.best(0.5F).area, 9.9F * 0.3F, 0.1F) << "as wide as anything is";
}

TEST(BestCut, OnePlaceCannotBeCut) {
  Cut place;
  for (int i = 0; i < 3; ++i) place.points.push_back(1, 2, 0, 0);
  EXPECT_EQ(place.best(0.5F).area, std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace scree
