#include "training/labels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "scree/detect/detector.hpp"
#include "unit/detect/clouds.hpp"

namespace scree {
namespace {

using test::kBowlX, test::kBumpX, test::kRoundRadius;
using testing::ElementsAre, testing::IsEmpty, testing::UnorderedElementsAre;

Footprint rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// Around the bump or the bowl of the cloud.
Footprint around(double x, double radius = static_cast<double>(kRoundRadius)) {
  return rectangle(x - radius, -radius, x + radius, radius);
}

TerrainFeature feature(int id, std::optional<ObstacleKind> kind, const Footprint& footprint) {
  TerrainFeature feature;
  feature.id = id;
  feature.kind = kind;
  feature.footprint = footprint;
  return feature;
}

/// A cloud with two clusters, that of a bump and that of a bowl, and features at will.
class Labels : public testing::Test {
protected:
  static void SetUpTestSuite() {
    detector_ = new Detector(DetectSettings::for_cloud(), kLimits, Network());
    FixedVector<Obstacle> unused(1);
    detector_->detect(test::bump_and_bowl(50'000), unused);
  }
  static void TearDownTestSuite() {
    delete detector_;
    detector_ = nullptr;
  }

  void SetUp() override { ASSERT_EQ(detector_->clustered().clusters.all().size(), 2U); }

  static LabelledClusters label(const std::vector<TerrainFeature>& features,
                                const std::vector<int>& asked = {}) {
    return label_clusters(detector_->clustered(), features, asked);
  }

  static std::vector<Label> labels(const std::vector<TerrainFeature>& features) {
    std::vector<Label> labels;
    for (const Sample& sample : label(features).samples) labels.push_back(sample.label);
    return labels;
  }

  static constexpr auto kRock = ObstacleKind::positive, kHole = ObstacleKind::negative;

  static constexpr DetectorLimits kLimits{
      .points = 60'000, .candidates = 30'000, .ground_cells = 1 << 15, .obstacles = 256};

private:
  static inline Detector* detector_ = nullptr;
};

TEST_F(Labels, RocksAndHolesAreWhatTheyAre) {
  EXPECT_THAT(labels({feature(1, kRock, around(kBumpX)), feature(2, kHole, around(kBowlX))}),
              UnorderedElementsAre(Label::positive, Label::negative));
}

TEST_F(Labels, WithoutAnyFeatureAllAreNone) {
  EXPECT_THAT(labels({}), ElementsAre(Label::none, Label::none));
}

TEST_F(Labels, AnObstacleOnAMoundIsItself) {
  const auto mound = feature(1, std::nullopt, around(kBumpX, 2));
  EXPECT_THAT(labels({mound}), ElementsAre(Label::none, Label::none));
  EXPECT_THAT(labels({mound, feature(2, kRock, around(kBumpX))}),
              UnorderedElementsAre(Label::positive, Label::none));
}

TEST_F(Labels, TheRimOfACraterIsNone) {
  EXPECT_THAT(labels({feature(1, kHole, around(kBumpX))}), ElementsAre(Label::none, Label::none));
}

TEST_F(Labels, AHollowBesideARockIsNone) {
  EXPECT_THAT(labels({feature(1, kRock, around(kBowlX))}), ElementsAre(Label::none, Label::none));
}

TEST_F(Labels, SmallStonesAndDentsAreLeftOut) {
  std::vector<TerrainFeature> features = {feature(1, kRock, around(kBumpX)),
                                          feature(2, kHole, around(kBowlX))};
  features[0].is_small = true;
  EXPECT_THAT(labels(features), ElementsAre(Label::negative));
  features[1].is_small = true;
  EXPECT_THAT(labels(features), IsEmpty());
}

TEST_F(Labels, HalfOfThePointsInTheFootprintAreEnough) {
  // A slit leaves the middle of the bump out; then a strip reaches its edge only.
  const double x = kBumpX;
  const Footprint most = {{x - 1, -1},     {x + 1, -1},     {x + 1, 1},   {x + 0.2, 1},
                          {x + 0.2, -0.2}, {x - 0.2, -0.2}, {x - 0.2, 1}, {x - 1, 1}};
  EXPECT_THAT(labels({feature(1, kRock, most)}),
              UnorderedElementsAre(Label::positive, Label::none));
  const Footprint edge = rectangle(x + 0.4, -1, x + 1, 1);
  EXPECT_THAT(labels({feature(1, kRock, edge)}), ElementsAre(Label::none, Label::none));
}

TEST_F(Labels, PiecesBesideALargerOneAreLeftOut) {
  // As high as the bump, and a quarter as wide.
  PointCloud cloud = test::bump_and_bowl(50'000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float away = std::hypot(cloud.x[i] - kBumpX, cloud.y[i] - 1.5F) / (kRoundRadius / 4);
    if (away < 1) cloud.z[i] += 0.4F * (1 - away * away);
  }
  Detector detector(DetectSettings::for_cloud(), kLimits, Network());
  FixedVector<Obstacle> unused(1);
  detector.detect(cloud, unused);
  ASSERT_EQ(detector.clustered().clusters.all().size(), 3U);
  const TerrainFeature rocks = feature(1, kRock, rectangle(kBumpX - 1, -1, kBumpX + 1, 2));
  const auto labels_of = [&](double least_piece) {
    std::vector<Label> labels;
    const LabelledClusters labelled =
        label_clusters(detector.clustered(), {&rocks, 1}, {{1}}, least_piece);
    for (const Sample& sample : labelled.samples) labels.push_back(sample.label);
    EXPECT_EQ(labelled.found, 1U);
    return labels;
  };
  EXPECT_THAT(labels_of(0), UnorderedElementsAre(Label::positive, Label::positive, Label::none));
  EXPECT_THAT(labels_of(0.25), UnorderedElementsAre(Label::positive, Label::none));
}

TEST_F(Labels, CountsWhatIsAskedForAndFound) {
  const std::vector<TerrainFeature> features = {feature(1, kRock, around(kBumpX)),
                                                feature(2, kHole, around(kBowlX)),
                                                feature(3, kRock, rectangle(-3.5, 2, -2.5, 3))};
  LabelledClusters all = label(features, {1, 2, 3});
  EXPECT_EQ(all.obstacles, 3U);
  EXPECT_EQ(all.found, 2U);
  const LabelledClusters one = label(features, {2});
  EXPECT_EQ(one.obstacles, 1U);
  EXPECT_EQ(one.found, 1U);
  EXPECT_EQ(one.samples.size(), 2U);  // what is not asked for still has a label
  all += one;
  EXPECT_EQ(all.obstacles, 4U);
  EXPECT_EQ(all.found, 3U);
  EXPECT_EQ(all.samples.size(), 4U);
}

/// A rock at x = 3, a hole at 5 and a rock at 7, of 0.6 m, and the tracks of a robot at 1.
class TrackLabels : public testing::Test {
protected:
  TrackLabels() {
    for (int id = 1; id <= 3; ++id) {
      const double x = 1 + 2 * id;
      TrueObstacle obstacle;
      obstacle.id = id;
      obstacle.kind = id == 2 ? ObstacleKind::negative : ObstacleKind::positive;
      obstacle.center = {x, 0, 0};
      obstacle.footprint = rectangle(x - 0.3, -0.3, x + 0.3, 0.3);
      truth_.obstacles.push_back(obstacle);
    }
    base_.translation.x() = 1;
    truth_.poses = {{kStamp, base_}};
  }

  void add(double x, double height, float confidence = 0.9F, float found = 5) {
    Tracker::Track track;
    track.obstacle.center = {x, 0, 0};
    track.obstacle.extent = {0.4, 0.4, 0.4};
    track.obstacle.height = height;
    track.features[height > 0 ? track_positive : track_negative] = confidence;
    track.found = found;
    tracks_.push_back(track);
  }
  LabelledClusters label(const std::set<int>& known, double reach = 10) const {
    return label_tracks(tracks_, {.reach = reach}, base_, kStamp, truth_, known);
  }
  std::vector<Label> labels(const std::set<int>& known, double reach = 10) const {
    std::vector<Label> labels;
    for (const Sample& sample : label(known, reach).samples) labels.push_back(sample.label);
    return labels;
  }

  static constexpr std::int64_t kStamp = 1'000'000'000;
  Truth truth_;
  Pose base_;
  std::vector<Tracker::Track> tracks_;
};

TEST_F(TrackLabels, SayWhatTheContractWould) {
  add(3.1, 0.3);
  add(5.1, -0.3);
  add(9, 0.3);
  EXPECT_THAT(labels({1, 2}), UnorderedElementsAre(Label::positive, Label::negative, Label::none));
  EXPECT_EQ(label({1, 2}).obstacles, 2U);
  EXPECT_EQ(label({1, 2, 3}).found, 2U);
}

TEST_F(TrackLabels, TheRimOfAHoleIsNoRock) {
  add(5.1, 0.1);
  EXPECT_THAT(labels({1, 2, 3}), ElementsAre(Label::none));
}

TEST_F(TrackLabels, OfSeveralTracksOfARockTheSurestIsIt) {
  add(3, 0.3, 0.6F);
  add(3.2, 0.3, 0.8F);
  const LabelledClusters labelled = label({1});
  ASSERT_EQ(labelled.samples.size(), 2U);
  for (const Sample& sample : labelled.samples) {
    EXPECT_EQ(sample.label, sample.features[track_positive] > 0.7F ? Label::positive : Label::none);
  }
  EXPECT_EQ(labelled.found, 1U);
}

TEST_F(TrackLabels, LeaveOutWhatIsNotKnownYetOrFarOrFoundOnce) {
  add(7, 0.3);
  EXPECT_THAT(labels({1, 2}), IsEmpty()) << "not known";
  EXPECT_THAT(labels({3}), ElementsAre(Label::positive));
  EXPECT_THAT(labels({3}, 5.9), ElementsAre(Label::positive)) << "a part of it is near";
  EXPECT_THAT(labels({3}, 5.7), IsEmpty()) << "far";
  tracks_.clear();
  add(3, 0.3, 0.9F, 1);
  EXPECT_THAT(labels({1}), IsEmpty()) << "found once";
}

}  // namespace
}  // namespace scree
