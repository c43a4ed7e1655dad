// Gradient and suppression against the paper's formulas written out plainly, in double.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "detect/clouds.hpp"
#include "detect/slope_by_formula.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/suppression.hpp"

namespace scree {
namespace {

struct Slopes {
  std::vector<float> x, y;
};

Slopes slopes_of(const PlaneCells& cells, const ElevationGradient& gradient) {
  Slopes slopes{std::vector<float>(cells.size()), std::vector<float>(cells.size())};
  gradient.compute(cells, slopes.x, slopes.y);
  return slopes;
}

class Gradient : public testing::TestWithParam<double> {};  // bandwidth in radii

TEST_P(Gradient, IsTheFormulaOfThePaper) {
  const PointCloud cloud = test::bump_and_bowl(4000);
  const double d = 0.2, r = 0.23, bandwidth = GetParam() * r;
  const int least = 2;
  const ElevationGradient gradient{float(d), float(r), float(bandwidth), least};
  PlaneCells cells(cloud.size());
  cells.build(cloud, gradient.reach());
  const Slopes slopes = slopes_of(cells, gradient);

  std::size_t known = 0, on_the_rim = 0;
  for (std::size_t i = 0; i < cells.size(); i += 7) {
    const double x = cells.points().x[i], y = cells.points().y[i];
    const auto slope = test::slope_by_formula(cloud, x, y, {d, r, bandwidth, least});
    if (!slope) {
      EXPECT_TRUE(std::isnan(slopes.x[i]) && std::isnan(slopes.y[i]));
      continue;
    }
    ++known;
    // A neighbour on the rim of a disc may fall on either side in float.
    if (!test::is_slope(slopes.x[i], slopes.y[i], *slope)) ++on_the_rim;
  }
  EXPECT_GT(known, 300U);
  EXPECT_LE(on_the_rim, known / 100);
}

INSTANTIATE_TEST_SUITE_P(Bandwidths, Gradient, testing::Values(2.0, 1.0, 0.3, 0.1));

TEST(Gradient, OfAPlaneIsItsSlope) {
  PointCloud cloud = test::scattered(20'000, 3, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.z[i] = 0.3F * cloud.x[i] - 0.1F * cloud.y[i];
  const ElevationGradient gradient{0.2F, 0.25F, 0.5F, 3};
  PlaneCells cells(cloud.size());
  cells.build(cloud, gradient.reach());
  const Slopes slopes = slopes_of(cells, gradient);
  double sum_x = 0, sum_y = 0, known = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    // Near the rim of the cloud neighbours lack on one side, which biases the estimate.
    const bool inner =
        std::max(std::abs(cells.points().x[i]), std::abs(cells.points().y[i])) < 2.5F;
    if (std::isnan(slopes.x[i]) || !inner) continue;
    sum_x += slopes.x[i];
    sum_y += slopes.y[i];
    ++known;
  }
  EXPECT_GT(known, 10'000);
  EXPECT_NEAR(sum_x / known, 0.3, 0.003);
  EXPECT_NEAR(sum_y / known, -0.1, 0.003);
}

TEST(Gradient, IsUnknownNotZeroWhereNeighboursLack) {
  PointCloud cloud(3);
  cloud.push_back(0, 0, 0, 0);
  cloud.push_back(0.1F, 0, 0, 0);
  cloud.push_back(50, 50, 0, 0);
  const ElevationGradient gradient{0.1F, 0.11F, 0.22F, 1};
  PlaneCells cells(3);
  cells.build(cloud, gradient.reach());
  const Slopes slopes = slopes_of(cells, gradient);
  for (const float slope : slopes.x) EXPECT_TRUE(std::isnan(slope));
}

TEST(Suppression, KeepsWhatThePaperKeeps) {
  const PointCloud cloud = test::bump_and_bowl(20'000);
  const ElevationGradient gradient{0.1F, 0.12F, 0.24F, 1};
  PlaneCells cells(cloud.size());
  cells.build(cloud, gradient.reach());
  const Slopes slopes = slopes_of(cells, gradient);
  CandidatePoints edges(cloud.size()), kept(cloud.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::hypot(slopes.x[i], slopes.y[i]) >= 0.3F) {
      edges.push_back(cells.points(), i, slopes.x[i], slopes.y[i]);
    }
  }
  ASSERT_GT(edges.size(), 500U);
  const Suppression suppression{0.1F, 0.11F};
  PlaneCells work(cloud.size());
  suppression.suppress(edges, work, kept);

  const auto mean_around = [&](double x, double y) {
    double sum = 0;
    int count = 0;
    for (std::size_t j = 0; j < edges.size(); ++j) {
      if (std::hypot(edges.points.x[j] - x, edges.points.y[j] - y) > suppression.radius) continue;
      sum += std::hypot(edges.slope_x[j], edges.slope_y[j]);
      ++count;
    }
    return count == 0 ? 0 : sum / count;
  };
  std::vector<std::pair<float, float>> expected, actual;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double steepness = std::hypot(edges.slope_x[i], edges.slope_y[i]);
    const double half = suppression.distance / 2 / steepness;
    const double dx = edges.slope_x[i] * half, dy = edges.slope_y[i] * half;
    const double x = edges.points.x[i], y = edges.points.y[i];
    if (steepness >= mean_around(x + dx, y + dy) && steepness >= mean_around(x - dx, y - dy)) {
      expected.emplace_back(edges.points.x[i], edges.points.y[i]);
    }
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    actual.emplace_back(kept.points.x[i], kept.points.y[i]);
  }
  std::ranges::sort(expected);
  std::ranges::sort(actual);
  std::vector<std::pair<float, float>> differing;
  std::ranges::set_symmetric_difference(expected, actual, std::back_inserter(differing));
  EXPECT_GT(expected.size(), 100U);
  EXPECT_LT(expected.size(), edges.size() / 2);
  EXPECT_LE(differing.size(), expected.size() / 100) << "more than points on a rim can explain";
}

}  // namespace
}  // namespace scree
