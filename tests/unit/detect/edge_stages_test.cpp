// Gradient and suppression against the paper's formulas written out plainly, in double.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "detect/clouds.hpp"
#include "scree/detect/elevation_gradient.hpp"
#include "scree/detect/suppression.hpp"

namespace scree {
namespace {

/// Eq. 3-4 at one position; nothing where fewer than `least` points lie within r.
std::optional<double> kernel_estimate(const PointCloud& cloud, double x, double y, double r,
                                      double bandwidth, int least) {
  double weights = 0, sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double dx = cloud.x[i] - x, dy = cloud.y[i] - y;
    if (dx * dx + dy * dy > r * r) continue;
    const double k = 0.6171 * std::exp(-0.5 * std::pow(dx / bandwidth, 2)) *
                     std::exp(-0.5 * std::pow(dy / bandwidth, 2));
    weights += k;
    sum += k * cloud.z[i];
    ++count;
  }
  if (count < least) return std::nullopt;
  return sum / weights;
}

struct Slopes {
  std::vector<float> x, y;
};

Slopes slopes_of(const PlaneCells& cells, const ElevationGradient& gradient) {
  Slopes slopes{std::vector<float>(cells.size()), std::vector<float>(cells.size())};
  gradient.compute(cells, {}, slopes.x, slopes.y);
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
    std::array<std::array<std::optional<double>, 3>, 3> z;
    bool complete = true;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        if (row == 1 && column == 1) continue;
        z[row][column] = kernel_estimate(cloud, x + (double(column) - 1) * d,
                                         y + (double(row) - 1) * d, r, bandwidth, least);
        complete = complete && z[row][column];
      }
    }
    if (!complete) {
      EXPECT_TRUE(std::isnan(slopes.x[i]) && std::isnan(slopes.y[i]));
      continue;
    }
    ++known;
    const double slope_x =
        (*z[0][2] + 2 * *z[1][2] + *z[2][2] - *z[0][0] - 2 * *z[1][0] - *z[2][0]) / (8 * d);
    const double slope_y =
        (*z[2][0] + 2 * *z[2][1] + *z[2][2] - *z[0][0] - 2 * *z[0][1] - *z[0][2]) / (8 * d);
    // A neighbour on the rim of a disc may fall on either side in float.
    if (std::abs(slopes.x[i] - slope_x) > 1e-4 || std::abs(slopes.y[i] - slope_y) > 1e-4) {
      ++on_the_rim;
    }
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

TEST(Gradient, PointsAboveOneAnotherMayShareIt) {
  // Every point has three more above it, some millimetres aside.
  const PointCloud plane = test::scattered(5'000, 2, 0);
  PointCloud cloud(4 * plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const float ground = 0.4F * std::sin(2 * plane.x[i]) * plane.y[i];
    for (int k = 0; k < 4; ++k) {
      const float up = static_cast<float>(k);
      cloud.push_back(plane.x[i] + 0.002F * up, plane.y[i], ground + 0.1F * up, 0);
    }
  }
  ElevationGradient gradient{0.1F, 0.11F, 0.22F, 1};
  PlaneCells cells(cloud.size());
  cells.build(cloud, gradient.reach());
  const Slopes own = slopes_of(cells, gradient);
  gradient.shared_within = 0.01F;
  const Slopes shared = slopes_of(cells, gradient);
  std::size_t known = 0;
  double difference = 0;
  std::set<float> distinct_own, distinct_shared;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (std::isnan(own.x[i]) || std::isnan(shared.x[i])) continue;
    ++known;
    difference += std::hypot(own.x[i] - shared.x[i], own.y[i] - shared.y[i]);
    distinct_own.insert(own.x[i]);
    distinct_shared.insert(shared.x[i]);
  }
  ASSERT_GT(known, 10'000U);
  EXPECT_LT(difference / static_cast<double>(known), 0.03);
  EXPECT_LT(distinct_shared.size(), 0.4 * static_cast<double>(distinct_own.size()));

  // What is not wanted lends its slope to nobody.
  std::vector<std::uint8_t> wanted(cells.size(), 0);
  for (std::size_t i = 0; i < wanted.size(); i += 3) wanted[i] = 1;
  Slopes some{std::vector<float>(cells.size()), std::vector<float>(cells.size())};
  gradient.compute(cells, wanted, some.x, some.y);
  std::size_t asked = 0, alike = 0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == 0) {
      ASSERT_TRUE(std::isnan(some.x[i]));
    } else if (!std::isnan(own.x[i])) {
      ++asked;
      alike += std::hypot(some.x[i] - own.x[i], some.y[i] - own.y[i]) < 0.1F ? 1U : 0U;
    }
  }
  EXPECT_GT(asked, known / 4);
  EXPECT_GT(alike, 0.9 * static_cast<double>(asked));
}

TEST(PlaneCells, WithoutSomePointsTheyAreAsBuiltFromTheOthers) {
  const PointCloud cloud = test::scattered(5'000, 2, 1);
  const auto leave_out = [](float x, float z) { return z > 0.2F || x < -1.5F; };
  PointCloud others(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (leave_out(cloud.x[i], cloud.z[i])) continue;
    others.push_back(cloud.x[i], cloud.y[i], cloud.z[i], cloud.reflectivity[i]);
  }
  PlaneCells cells(cloud.size()), expected(cloud.size());
  cells.build(cloud, 0.1F);
  expected.build(others, 0.1F);
  cells.remove([&](std::size_t i) { return leave_out(cells.points().x[i], cells.points().z[i]); });
  const auto points_of = [](const PlaneCells& of) {
    const PointCloud& at = of.points();
    std::vector<std::array<float, 4>> points;
    for (std::size_t i = 0; i < of.size(); ++i) {
      points.push_back({at.x[i], at.y[i], at.z[i], at.reflectivity[i]});
    }
    return points;
  };
  const auto runs_of = [](const PlaneCells& of) {
    std::vector<std::uint32_t> ends;
    of.for_each_cell([&](auto cell, auto neighbourhood) {
      ends.insert(ends.end(), {cell.begin, cell.end});
      for (const auto& run : neighbourhood) ends.insert(ends.end(), {run.begin, run.end});
    });
    return ends;
  };
  EXPECT_EQ(points_of(cells), points_of(expected));
  EXPECT_GT(cells.size(), 1'000U);
  EXPECT_EQ(runs_of(cells), runs_of(expected));
  cells.remove([](std::size_t) { return true; });
  EXPECT_EQ(cells.size(), 0U);
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
