#include <gtest/gtest.h>

#include <random>

#include "scree/terrain/rolling_map.hpp"

namespace scree {
namespace {

/// A lidar 1 m above level ground looks ahead; a box stands on the ground there, or grass of its
/// size, or nothing.
class Scene {
public:
  bool has_box = true;
  double box_height = 0.5;  ///< metres
  double blades = 0;        ///< met a metre of way; 0: the box is solid

  const RollingMap& map() const { return map_; }

  void look(int sweeps) {
    std::normal_distribution<double> noise(0, 0.005);
    std::uniform_real_distribution<double> shake(-0.0025, 0.0025);
    for (int i = 0; i < sweeps; ++i) {
      sweep_.clear();
      const double up_by = shake(random_), side_by = shake(random_);
      for (int row = 0; row < 90; ++row) {
        for (int column = 0; column < 120; ++column) {
          const double up = up_by - 0.008 * row - 0.09, side = side_by + 0.008 * (column - 60);
          const Eigen::Vector3d along(std::cos(up) * std::cos(side), std::cos(up) * std::sin(side),
                                      std::sin(up));
          const double range = cast(along) + noise(random_);
          const Eigen::Vector3f hit = (kLidar + range * along).cast<float>();
          sweep_.points.push_back(hit.x(), hit.y(), hit.z(), 20);
          sweep_.origins.push_back(kLidar.cast<float>());
          sweep_.scatter.push_back(0);
          sweep_.is_isolated.push_back(0);
          sweep_.is_moving.push_back(0);
          sweep_.is_suspect.push_back(0);
        }
      }
      map_.add(sweep_, Pose(), now_ns_ += 100'000'000);
    }
  }
  struct Counts {
    int box = 0, ground = 0;
    double ended = 0, passed = 0;  ///< beams that came to the box
    double solidity() const { return ended / (ended + passed); }
  };
  Counts counts() const {
    Counts counts;
    for (std::size_t i = 0; i < map_.cloud().size(); ++i) {
      const float x = map_.cloud().x[i], y = map_.cloud().y[i], z = map_.cloud().z[i];
      const bool is_box = z > 0.08F && x > 2.8F && x < 3.6F && std::abs(y) < 0.6F;
      (is_box ? counts.box : counts.ground) += 1;
      if (!is_box) continue;
      counts.ended += map_.beams()[i].ended;
      counts.passed += map_.beams()[i].passed;
    }
    return counts;
  }

private:
  // The box: its face 3 m ahead, 1 m wide, 0.5 m deep.
  double cast(const Eigen::Vector3d& along) {
    double range = -kLidar.z() / along.z();
    if (!has_box) return range;
    const auto hits = [&](double way) {
      const Eigen::Vector3d at = kLidar + way * along;
      return std::abs(at.y()) < 0.5 && at.z() < box_height + 1e-9 && at.x() > 3 - 1e-9 &&
             at.x() < 3.5;
    };
    for (const double way : {3 / along.x(), (box_height - kLidar.z()) / along.z()}) {
      if (!hits(way)) continue;
      const double blade = blades > 0 ? way - std::log(1 - chance_(random_)) / blades : way;
      if (blade == way || blade < 3.5 / along.x()) range = std::min(range, blade);
    }
    return range;
  }

  inline static const Eigen::Vector3d kLidar{0, 0, 1};
  RollingMap map_{MapSettings{}, 1 << 17};
  DeskewedSweep sweep_{1 << 14};
  std::mt19937 random_{31};
  std::uniform_real_distribution<double> chance_{0, 1};
  std::int64_t now_ns_ = 1'598'612'523'000'000'000;
};

TEST(RollingMapScene, WhatMovedAwayIsForgottenAndWhatStandsStays) {
  Scene scene;
  scene.look(20);
  const Scene::Counts with = scene.counts();
  EXPECT_GT(with.box, 150);
  EXPECT_GT(with.ground, 3000);
  EXPECT_EQ(scene.map().occupancy_at({3, 0, 0.3}), Occupancy::occupied);

  scene.look(150);
  const Scene::Counts later = scene.counts();
  EXPECT_GT(later.box, 0.97 * with.box);
  EXPECT_GT(later.ground, 0.97 * with.ground);

  scene.has_box = false;
  scene.look(60);
  const Scene::Counts without = scene.counts();
  EXPECT_LT(without.box, 0.05 * with.box);
  EXPECT_GT(without.ground, with.ground) << "also where the box stood, and behind it";
  EXPECT_EQ(scene.map().occupancy_at({3, 0, 0.3}), Occupancy::free);
}

// The beams that show that it is gone end far behind where it stood.
TEST(RollingMapScene, WhatMovedAwayInTheOpenIsForgotten) {
  Scene scene;
  scene.box_height = 0.85;
  scene.look(20);
  const auto upper_part = [&] {
    const PointCloud& cloud = scene.map().cloud();
    int points = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (cloud.z[i] > 0.55F && cloud.z[i] < 0.7F) ++points;
    }
    return points;
  };
  const int with = upper_part();
  EXPECT_GT(with, 30);
  scene.has_box = false;
  scene.look(60);
  EXPECT_LT(upper_part(), 0.05 * with);
}

TEST(RollingMapScene, CountsTheBeamsThatGrassLetsPass) {
  Scene box, sparse, dense;
  sparse.blades = 2;
  dense.blades = 8;
  for (Scene* scene : {&box, &sparse, &dense}) scene->look(20);
  EXPECT_GT(box.counts().solidity(), 0.9);
  EXPECT_LT(dense.counts().solidity(), 0.75 * box.counts().solidity());
  EXPECT_LT(sparse.counts().solidity(), 0.5 * dense.counts().solidity());
}

// From afar the beams skim over its top.
TEST(RollingMapScene, ALowBoxLetsNothingPass) {
  Scene scene;
  scene.box_height = 0.2;
  scene.look(40);
  EXPECT_GT(scene.counts().solidity(), 0.97);
}

TEST(RollingMapScene, TellsUnseenFromEmpty) {
  Scene scene;
  scene.look(20);
  EXPECT_EQ(scene.map().occupancy_at({3, 0, 0.25}), Occupancy::occupied);
  EXPECT_EQ(scene.map().occupancy_at({2, 0, 0}), Occupancy::occupied) << "the ground";
  EXPECT_EQ(scene.map().occupancy_at({1.5, 0, 0.6}), Occupancy::free);
  EXPECT_EQ(scene.map().occupancy_at({4.3, 0, 0.15}), Occupancy::unknown) << "in the box's shadow";
  EXPECT_EQ(scene.map().occupancy_at({3, 0, 2}), Occupancy::unknown) << "above all beams";
  EXPECT_EQ(scene.map().occupancy_at({-3, 0, 0.5}), Occupancy::unknown) << "behind";
  EXPECT_EQ(scene.map().occupancy_at({2, 0, -0.6}), Occupancy::unknown) << "below ground";
  EXPECT_EQ(scene.map().occupancy_at({300, 0, 0}), Occupancy::unknown);
}

TEST(RollingMapScene, IsTheSameOnEveryRun) {
  Scene a, b;
  a.look(5);
  b.look(5);
  ASSERT_EQ(a.map().cloud().size(), b.map().cloud().size());
  for (std::size_t i = 0; i < a.map().cloud().size(); ++i) {
    ASSERT_EQ(a.map().cloud().x[i], b.map().cloud().x[i]);
    ASSERT_EQ(a.map().cloud().z[i], b.map().cloud().z[i]);
  }
}

}  // namespace
}  // namespace scree
