#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "detect/tracked_obstacles.hpp"

namespace scree {
namespace {

using TrackerNetworkTest = TrackerTest;

// A rock only where something is high, a hole only where it is deep.
Network height_network() {
  constexpr double kSure = 1000;
  Network network(2, kTrackFeatures);
  network.forms.fill(InputForm::raw);
  const std::span<double> weights = network.weights();
  constexpr std::size_t kRow = kTrackFeatures + 1;
  weights[track_height] = kSure;
  weights[kTrackFeatures] = -0.6 * kSure;
  weights[kRow + track_height] = -kSure;
  weights[kRow + kTrackFeatures] = -0.6 * kSure;
  // Outputs: what the units say, 0 or 1, becomes sigmoid(-3) or sigmoid(3).
  for (std::size_t output = 0; output < Network::kOutputs; ++output) {
    weights[network.output_row(output) + output] = 6;
    weights[network.output_row(output) + 2] = -3;
  }
  return network;
}

TEST_F(TrackerNetworkTest, TheNetworkDecidesWhatIsPublishedAndAsWhat) {
  tracker_ = Tracker(settings_, kMost, height_network());
  EXPECT_EQ(update({at(3, 1, 0.99F)}, 10).size(), 0U) << "sure, but the network says no";
  Obstacle high = at(3, 1, 0.2F);
  high.height = 0.7;
  ASSERT_EQ(update({high}).size(), 1U) << "unsure, but the network says yes";
  EXPECT_EQ(list_[0].kind, ObstacleKind::positive);
  EXPECT_NEAR(list_[0].confidence, 1 / (1 + std::exp(-3)), 1e-6);
  tracker_ = Tracker(settings_, kMost, height_network());
  Obstacle deep = at(3, 1);
  deep.height = -0.7;
  update({deep}, 2);
  ASSERT_EQ(list_.size(), 1U);
  EXPECT_EQ(list_[0].kind, ObstacleKind::negative) << "whatever the detector says";
}

TEST_F(TrackerNetworkTest, WhatTheDetectorNoLongerFindsGoesWhateverTheNetworkSays) {
  tracker_ = Tracker(settings_, kMost, height_network());
  Obstacle high = at(3, 1);
  high.height = 1;
  update({high}, 10);
  ASSERT_EQ(list_.size(), 1U);
  occupancy_ = Occupancy::free;
  EXPECT_LE(updates_until(0, {}), 4);
}

TEST_F(TrackerNetworkTest, AListThatMissesItDoesNotMakeItFlicker) {
  constexpr double kSure = 100;
  Network strict(1, kTrackFeatures);  // the least doubt is too much for it
  strict.forms.fill(InputForm::raw);
  strict.weights()[track_positive] = kSure;
  strict.weights()[kTrackFeatures] = -0.8 * kSure;
  strict.weights()[strict.output_row(0)] = 12;
  strict.weights()[strict.output_row(0) + 1] = -6;
  strict.weights()[strict.output_row(1) + 1] = -6;
  tracker_ = Tracker(settings_, kMost, strict);
  ASSERT_EQ(update({at(3, 1)}, 10).size(), 1U);
  const std::int64_t id = list_[0].id;
  ASSERT_EQ(update({}).size(), 1U);
  ASSERT_EQ(update({at(3, 1)}, 3).size(), 1U);
  EXPECT_EQ(list_[0].id, id);
  EXPECT_LE(updates_until(0, {}), 6) << "but it goes";
}

TEST_F(TrackerNetworkTest, AllocatesNothing) {
  tracker_ = Tracker(settings_, kMost, height_network());
  const std::vector<Obstacle> found(kMost, at(3, 1));
  const std::size_t before = test::allocations();
  update(found, 20);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace scree
