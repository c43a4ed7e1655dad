#include "setup_angles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "scree/core/pose.hpp"

namespace scree {

Eigen::Vector3d roll_pitch_yaw_deg(const Eigen::Matrix3d& rotation) {
  const double level = std::hypot(rotation(0, 0), rotation(1, 0));
  return {degrees(std::atan2(rotation(2, 1), rotation(2, 2))),
          degrees(std::atan2(-rotation(2, 0), level)),
          degrees(std::atan2(rotation(1, 0), rotation(0, 0)))};
}

std::array<Eigen::Matrix3d, 24> all_quarter_turns() {
  std::array<Eigen::Matrix3d, 24> turns;
  std::size_t count = 0;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) {
        turn(i, axes[static_cast<std::size_t>(i)]) = (signs >> i & 1) != 0 ? -1 : 1;
      }
      if (turn.determinant() > 0) turns[count++] = turn;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  // Those that turn least axes away from themselves come first.
  std::stable_sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) {
    const auto rank = [](const Eigen::Matrix3d& turn) {
      const double kept = turn.diagonal().cwiseAbs().sum();  // 3 for none and half turns
      return 10 * kept + (turn.trace() > 2.5 ? 5 : 0) + turn(0, 0);
    };
    return rank(a) > rank(b);
  });
  return turns;
}

}  // namespace scree
