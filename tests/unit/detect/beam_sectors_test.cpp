#include "scree/detect/beam_sectors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace scree {
namespace {

const Eigen::Vector3f kAboveRings(0, 0, 1);

/// Rings of level ground, and points behind the one at 4 m.
struct Rings {
  PointCloud cloud{20'000};
  std::vector<std::uint32_t> members;

  explicit Rings(std::initializer_list<float> ranges) {
    for (const float range : ranges) {
      for (int i = 0; i < 1800; ++i) {
        const float azimuth = static_cast<float>(i) * 0.0034907F;
        cloud.push_back(range * std::cos(azimuth), range * std::sin(azimuth), 0, 0);
      }
    }
  }
  void add(float range, float z) {
    for (int i = -3; i <= 3; ++i) {
      members.push_back(static_cast<std::uint32_t>(cloud.size()));
      const float azimuth = 0.5F + 0.01F * static_cast<float>(i);
      cloud.push_back(range * std::cos(azimuth), range * std::sin(azimuth), z, 0);
    }
  }
  Evidence evidence() const {
    BeamSectors sectors(20'000);
    sectors.build(cloud, kAboveRings);
    return sectors.of(members, cloud, 0);
  }
};

TEST(BeamSectors, AWallBehindGroundThatWasSeenIsAHole) {
  Rings rings({3, 4, 7});
  rings.add(5.2F, -0.2F);  // the beam passed the level of the ground 4.33 m away
  EXPECT_EQ(rings.evidence(), Evidence::inside);
}

TEST(BeamSectors, BehindGroundThatTheBeamWouldHavePassedThroughIsNone) {
  Rings rings({3, 4, 4.8F, 7});
  rings.add(5.2F, -0.2F);
  EXPECT_EQ(rings.evidence(), Evidence::none);
}

TEST(BeamSectors, WithoutGroundBeforeItThereIsNone) {
  Rings rings({1.5F, 9});
  rings.add(5.2F, -0.2F);
  EXPECT_EQ(rings.evidence(), Evidence::none);
}

TEST(BeamSectors, AboveTheSensorThereIsNone) {
  Rings rings({3, 4, 7});
  rings.add(5, 2);
  BeamSectors sectors(20'000);
  sectors.build(rings.cloud, kAboveRings);
  EXPECT_EQ(sectors.of(rings.members, rings.cloud, 2.5F), Evidence::none);
}

}  // namespace
}  // namespace scree
