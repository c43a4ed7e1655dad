#include <gtest/gtest.h>

#include <memory>

#include "simulator/drive.hpp"

namespace scree {
namespace {

struct Heard {
  std::size_t sweeps = 0, points = 0;
  std::unique_ptr<SyncBuffer> sensors = std::make_unique<SyncBuffer>();
  std::unique_ptr<SyncBuffer> others = std::make_unique<SyncBuffer>();
  std::vector<Truth::Sight> visible;

  Heard(const Drive& drive, const Faults& faults) {
    DriveFeed feed(drive, faults);
    for (Sweep sweep(1 << 15); feed.next(sweep, {sensors.get(), others.get()});) {
      ++sweeps;
      points += sweep.points.size();
      sensors->gather();
      others->gather();
    }
    visible = feed.truth().visible;
  }

  template <class Sample>
  static std::size_t within(const SampleHistory<Sample>& history, const Gap& gap) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < history.size(); ++i)
      count += gap.holds(since_start(history[i].t_ns));
    return count;
  }
};

TEST(DriveFeed, LosesWhatTheFaultsTakeAndNothingElse) {
  CaptureSettings settings;
  settings.seconds = 4;
  settings.cell = 0.06;
  settings.margin = 13;
  const Drive drive(settings);
  const Heard whole(drive, DriveFeed::kNoFaults);
  const Gap imu_gap{0.5, 1.5};
  const Gap encoder_gap{2.5, 1};
  const Heard faulty(drive, {.packet_loss = 0.05,
                             .imu_corruption = 0.002,
                             .imu_gap = imu_gap,
                             .encoder_gap = encoder_gap});
  EXPECT_EQ(whole.sweeps, 40U);
  EXPECT_EQ(faulty.sweeps, 40U);
  EXPECT_NEAR(static_cast<double>(faulty.points), 0.95 * static_cast<double>(whole.points),
              0.02 * static_cast<double>(whole.points));

  EXPECT_EQ(Heard::within(whole.sensors->imu(), imu_gap), 150U);
  EXPECT_EQ(Heard::within(faulty.sensors->imu(), imu_gap), 0U);
  EXPECT_EQ(Heard::within(whole.sensors->wheel(), encoder_gap), 100U);
  EXPECT_EQ(Heard::within(faulty.sensors->wheel(), encoder_gap), 0U);
  EXPECT_EQ(faulty.sensors->wheel().size(), whole.sensors->wheel().size() - 100);

  // 73 bytes a message: one in seven is hit.
  const std::size_t left = whole.sensors->imu().size() - 150;
  EXPECT_LT(faulty.sensors->imu().size(), left - 15);
  EXPECT_GT(faulty.sensors->imu().size(), left * 3 / 4);
  const ImuSample& last = faulty.sensors->imu().newest();
  const auto true_attitude = whole.sensors->attitude_at(last.t_ns);
  ASSERT_TRUE(true_attitude);
  EXPECT_LT(last.orientation.angularDistance(true_attitude->rotation), 0.01);

  EXPECT_EQ(faulty.others->imu().size(), faulty.sensors->imu().size());
  EXPECT_EQ(faulty.others->wheel().size(), faulty.sensors->wheel().size());
  ASSERT_EQ(faulty.visible.size(), whole.visible.size());
  EXPECT_EQ(faulty.visible.back().ids, whole.visible.back().ids) << "as of the lidar itself";
}

}  // namespace
}  // namespace scree
