#include "scree/terrain/surfel_map.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>
#include <vector>

#include "allocation_counter.hpp"

namespace scree {
namespace {

constexpr float kCell = 0.3F;

/// Points of a rough plane within the cell whose lowest corner is given.
std::vector<Eigen::Vector3f> patch(const Eigen::Vector3d& corner, const Eigen::Vector3d& normal,
                                   int points, double thickness, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.02, 0.28);
  std::normal_distribution<double> noise(0, thickness);
  std::vector<Eigen::Vector3f> cloud;
  while (static_cast<int>(cloud.size()) < points) {
    const double x = uniform(random), y = uniform(random);
    const double z =
        0.15 - (normal.x() * (x - 0.15) + normal.y() * (y - 0.15)) / normal.z() + noise(random);
    if (z < 0.01 || z > 0.29) continue;
    cloud.push_back((corner + Eigen::Vector3d(x, y, z)).cast<float>());
  }
  return cloud;
}

TEST(SurfelMap, IsTheEigenDecompositionOfItsPoints) {
  std::mt19937 random(11);
  SurfelMap map(kCell);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d corner(0.3 * (i * 7 - 100), 0.3 * (50 - 3 * i), 0.3 * (i % 5 - 2));
    const Eigen::Vector3d normal =
        Eigen::Vector3d(0.02 * (i % 30), -0.015 * (i % 20), 1).normalized();
    const auto cloud = patch(corner, normal, 30 + 5 * i, 0.002 * (i % 6), random);
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& point : cloud) {
      map.add(point);
      mean += point.cast<double>() / static_cast<double>(cloud.size());
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& point : cloud) {
      const Eigen::Vector3d off = point.cast<double>() - mean;
      covariance += off * off.transpose() / static_cast<double>(cloud.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);

    const Surfel* const surfel = map.at(cloud.front());
    ASSERT_NE(surfel, nullptr) << i;
    EXPECT_LT((surfel->center.cast<double>() - mean).norm(), 1e-5);
    const Eigen::Vector3d best = solver.eigenvectors().col(0);
    EXPECT_GT(std::abs(surfel->normal.cast<double>().dot(best)), std::cos(2e-3)) << i;
    EXPECT_GT(surfel->normal.z(), 0);
    EXPECT_NEAR(surfel->normal.norm(), 1, 1e-5);
    const Eigen::Vector3d deviations = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
    EXPECT_NEAR(surfel->thickness, deviations[0], 2e-4) << i;
    EXPECT_NEAR(surfel->width, deviations[1], 2e-4) << i;
    EXPECT_EQ(surfel->points, static_cast<float>(cloud.size()));
  }
}

// Robots drive far: cells are told apart, and planes found, at any distance.
TEST(SurfelMap, WorksManyKilometresFromTheOrigin) {
  for (const double far : {-9830.4, 9830.1, 9830.7, 19'660.8, -40'000.2}) {
    std::mt19937 random(12);
    SurfelMap map(kCell);
    const double x = 0.3 * std::round(far / 0.3);
    const Eigen::Vector3d corner(x, -x, 0.6), normal = Eigen::Vector3d(0.2, 0.1, 1).normalized();
    const auto cloud = patch(corner, normal, 200, 0, random);
    for (const auto& point : cloud) map.add(point);
    const Eigen::Vector3f middle = (corner + Eigen::Vector3d::Constant(0.15)).cast<float>();
    const Surfel* const surfel = map.at(middle);
    ASSERT_NE(surfel, nullptr) << far;
    EXPECT_LT((surfel->center - middle).norm(), 0.03) << far;
    EXPECT_GT(surfel->normal.cast<double>().dot(normal), std::cos(0.02)) << far;
    EXPECT_LT(surfel->thickness, 0.004) << far;
  }
}

TEST(SurfelMap, KnowsNoPlaneWhereThereIsNone) {
  std::mt19937 random(13);
  SurfelMap map(kCell);
  const Eigen::Vector3f middle(0.15F, 0.15F, 0.15F);
  EXPECT_EQ(map.at(middle), nullptr) << "nothing";
  map.add(middle);
  EXPECT_EQ(map.at(middle), nullptr) << "a point";
  for (int i = 0; i < 100; ++i) map.add({0.02F + 0.0025F * static_cast<float>(i), 0.15F, 0.15F});
  EXPECT_EQ(map.at(middle), nullptr) << "a ring is a line";
  std::uniform_real_distribution<float> uniform(0, 0.3F);
  for (int i = 0; i < 300; ++i) map.add({uniform(random), uniform(random), uniform(random)});
  EXPECT_EQ(map.at(middle), nullptr) << "a bush";

  for (const auto& point : patch({3, 0, 0}, {0, 0, 1}, 50, 0, random)) map.add(point);
  EXPECT_NE(map.at({3.1F, 0.1F, 0.1F}), nullptr);
  EXPECT_EQ(map.at({3.1F, 0.1F, 0.31F}), nullptr) << "above it";
  EXPECT_EQ(map.at({3.1F, -0.1F, 0.1F}), nullptr) << "beside it";
  map.clear();
  EXPECT_EQ(map.at({3.1F, 0.1F, 0.1F}), nullptr);
}

TEST(SurfelMap, ForgetsAPlaceWhoseCellIsTakenOver) {
  std::mt19937 random(14);
  SurfelMap map(kCell);
  const Eigen::Vector3f here(0.15F, 0.15F, 0.15F);
  for (const auto& point : patch({0, 0, 0}, {0, 0, 1}, 50, 0, random)) map.add(point);
  ASSERT_NE(map.at(here), nullptr);
  // Far ahead along the same line of cells: whoever has the same memory takes it.
  for (int i = 1; i < 400; ++i) map.add(here + Eigen::Vector3f(0.3F * static_cast<float>(i), 0, 0));
  EXPECT_EQ(map.at(here), nullptr);
}

TEST(SurfelMap, ForgetsWhatItSawFirstWhereThereIsNoRoom) {
  std::mt19937 random(17);
  SurfelMap map(kCell, 1, 64);
  const std::vector<float> heights = {0, 3, 6};
  for (const float z : heights) {
    for (const auto& point : patch({0, 0, z}, {0, 0, 1}, 50, 0, random)) map.add(point);
  }
  const auto is_known = [&](float z) { return map.at({0.15F, 0.15F, z + 0.15F}) != nullptr; };
  EXPECT_FALSE(is_known(0));
  for (std::size_t i = 1; i < heights.size(); ++i) EXPECT_TRUE(is_known(heights[i])) << heights[i];
}

// Sweeps that are laid 2 cm off, one after the other, do not take the map along.
TEST(SurfelMap, KeepsAPlaneOfManyPoints) {
  std::mt19937 random(15);
  SurfelMap map(kCell);
  const auto cloud = patch({0, 0, 0}, {0, 0, 1}, 200, 0.001, random);
  for (const auto& point : cloud) map.add(point);
  const Eigen::Vector3f before = map.at(cloud.front())->center;
  for (const auto& point : cloud) map.add(point + Eigen::Vector3f(0, 0, 0.02F));
  const Surfel* const after = map.at(cloud.front());
  EXPECT_NEAR(after->center.z(), before.z(), 0.0015);
  EXPECT_GT(after->center.z(), before.z());
  EXPECT_LT(after->points, 220);

  // What has not become a plane has nothing to keep.
  const auto beside = patch({3, 0, 0}, {0, 0, 1}, 400, 0.001, random);
  for (const auto& point : beside) map.add({point.x(), 0.15F, point.z()});
  ASSERT_EQ(map.at(beside.front()), nullptr);
  for (const auto& point : beside) map.add(point);
  EXPECT_NE(map.at(beside.front()), nullptr);
}

TEST(SurfelMap, FollowsGroundThatChanges) {
  std::mt19937 random(15);
  SurfelMap map(kCell);
  const auto cloud = patch({0, 0, 0}, {0, 0, 1}, 2000, 0.001, random);
  for (const auto& point : cloud) map.add(point);
  const float before = map.at(cloud.front())->center.z();
  for (int i = 0; i < 16; ++i) {
    for (const auto& point : cloud) map.add(point + Eigen::Vector3f(0, 0, 0.02F));
  }
  EXPECT_NEAR(map.at(cloud.front())->center.z(), before + 0.02F, 1e-3);
}

TEST(SurfelMap, AllocatesNothing) {
  std::mt19937 random(16);
  SurfelMap map(kCell);
  const auto cloud = patch({0, 0, 0}, {0, 0, 1}, 1000, 0.001, random);
  const std::size_t before = test::allocations();
  for (const auto& point : cloud) {
    map.add(point);
    map.at(point);
  }
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
