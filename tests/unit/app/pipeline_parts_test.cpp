#include <gtest/gtest.h>

#include "driven_pipeline.hpp"

namespace scree {
namespace {

/// A pipeline that is also given what there is of each turn before its end.
class PipelineParts : public PipelineMap {
protected:
  static constexpr int kParts = 4;

  const ObstacleList& go_in_parts(int sweeps, bool speaks = true) {
    const ObstacleList* list = nullptr;
    for (int i = 0; i < sweeps; ++i) {
      measure(speaks);
      for (int part = 1; part < kParts; ++part) see_part(part);
      list = &pipeline_.process(sweep_);
      pose_ = list->pose;
    }
    return *list;
  }

  void see_part(int part) {
    const std::size_t count = sweep_.points.size() * static_cast<std::size_t>(part) / kParts;
    Sweep so_far(sweep_.points.size());
    so_far.copy_from(sweep_);
    so_far.points.resize(count);
    so_far.time_ns.resize(count);
    so_far.laser.resize(count);
    const std::int32_t end_ns = so_far.time_ns.back();
    so_far.shift(-end_ns);
    so_far.end_ns += end_ns;
    so_far.ends_turn = false;
    const ObstacleList& list = pipeline_.process(so_far);
    EXPECT_EQ(list.stamp_ns, so_far.end_ns);
    if (!pipeline_.has_looked()) return;
    ++parts_seen_;
    const double end = kSweep * sweeps_;
    const Pose moved = test::relative(pose_, list.pose);
    const Pose truth = test::relative(drive_.base(end - kSweep), drive_.base(end + 1e-9 * end_ns));
    EXPECT_LT((moved.translation - truth.translation).norm(), 0.01);
    EXPECT_LT(moved.rotation.angularDistance(truth.rotation), 0.003);
  }

  Pose pose_;  // at the end of the last turn
  int parts_seen_ = 0;
};

struct WholePipeline : PipelineMap {
  using PipelineMap::go, PipelineMap::pipeline_;
  void TestBody() override {}
};

TEST_F(PipelineParts, EachHasAListAndTheTurnsStayAsTheyAre) {
  constexpr int kTurns = 30;
  WholePipeline whole;
  const Pose pose = whole.go(kTurns).pose;
  const ObstacleList& list = go_in_parts(kTurns);
  EXPECT_EQ(list.pose.translation, pose.translation);
  EXPECT_EQ(list.pose.rotation, pose.rotation);
  EXPECT_GE(parts_seen_, (kParts - 1) * (kTurns - 2));
  const auto points = static_cast<double>(whole.pipeline_.ground().size());
  EXPECT_NEAR(static_cast<double>(pipeline_.ground().size()), points, 0.02 * points);
}

TEST_F(PipelineParts, WithoutImuAndEncoderTheyAreNotLookedAt) {
  ground_.roughness = 1.5;
  go_in_parts(10, false);
  EXPECT_TRUE(pipeline_.has_looked());
  EXPECT_EQ(parts_seen_, 0);
}

/// When the detector was too slow for some parts, the next one brings their points.
TEST_F(PipelineParts, OnesThatAreLeftOutCostNothing) {
  pose_ = go(20).pose;
  WholePipeline whole;
  whole.go(20);
  for (int i = 0; i < 10; ++i) {
    whole.go(1);
    measure(true);
    see_part(1 + i % 3);
    pose_ = pipeline_.process(sweep_).pose;
  }
  const auto points = static_cast<double>(whole.pipeline_.ground().size());
  EXPECT_NEAR(static_cast<double>(pipeline_.ground().size()), points, 0.02 * points);
}

}  // namespace
}  // namespace scree
