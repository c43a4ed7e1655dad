#include "scree/drivers/xsens/orientation.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <utility>

#include "scree/core/pose.hpp"
#include "unit/xsens/message_builder.hpp"

namespace scree::xsens {
namespace {

/// The sensor's axes in a local frame whose axes are the columns' names.
Measurement oriented(const Eigen::Matrix3d& local, unsigned frame, int parameters) {
  const Eigen::Quaterniond q(local);
  const Eigen::Vector3d angles = local.eulerAngles(2, 1, 0) * 180 / std::numbers::pi;
  ItemCounts counts;
  switch (parameters) {
    case 0:
      return decode_mt_data2(test::reals(0x2013 | frame, {q.w(), q.x(), q.y(), q.z()}), counts);
    case 1:
      return decode_mt_data2(test::reals(0x2023 | frame, {local(0, 0), local(1, 0), local(2, 0),
                                                          local(0, 1), local(1, 1), local(2, 1),
                                                          local(0, 2), local(1, 2), local(2, 2)}),
                             counts);
    default:
      return decode_mt_data2(test::reals(0x2033 | frame, {angles[2], angles[1], angles[0]}),
                             counts);
  }
}

TEST(Orientation, IsTheSameWhateverFrameAndParametersWereSent) {
  // What the sensor's axes are in east-north-up, and the same read off in the other frames.
  const Eigen::Matrix3d enu = from_roll_pitch_yaw(0.3, -0.4, 2.1).toRotationMatrix();
  Eigen::Matrix3d ned, nwu;
  ned << enu.row(1), enu.row(0), -enu.row(2);
  nwu << enu.row(1), -enu.row(0), enu.row(2);
  for (int parameters = 0; parameters < 3; ++parameters) {
    for (const auto& [local, frame] : {std::pair{enu, 0x0U}, {ned, 0x4U}, {nwu, 0x8U}}) {
      const auto orientation = orientation_enu(oriented(local, frame, parameters));
      ASSERT_TRUE(orientation);
      EXPECT_LT((orientation->toRotationMatrix() - enu).cwiseAbs().maxCoeff(), 1e-12)
          << frame << ' ' << parameters;
    }
    EXPECT_FALSE(orientation_enu(oriented(enu, 0xC, parameters)));
  }
  EXPECT_FALSE(orientation_enu({}));
}

}  // namespace
}  // namespace scree::xsens
