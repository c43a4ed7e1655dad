#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <optional>

#include "scree/core/random.hpp"
#include "simulator/motion.hpp"

namespace scree {

/// Dust that the wheels throw up: puffs that grow, thin out, rise and drift with the wind until
/// they are gone. Time goes forward only.
class Dust {
public:
  /// Keeps a reference to the motion.
  /// @param puffs a metre driven; 0: none
  Dust(double puffs, const Motion& motion, std::int64_t start_ns, std::uint64_t seed);

  /// Throws up what has come by now, and drops what is gone.
  void advance(std::int64_t t_ns);

  /// Range of the first grain that a beam meets before `max_range` metres; nothing for none.
  /// @param direction of length 1
  std::optional<double> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             std::int64_t t_ns, double max_range);

private:
  struct Puff {
    std::int64_t born_ns;
    Eigen::Vector3d place, drift;  ///< metres, m/s
    double radius, growth;         ///< metres, m/s
    double density;                ///< grains met a metre of beam, at birth
  };

  double puffs_;
  const Motion& motion_;
  Random random_;
  Eigen::Vector3d wind_ = Eigen::Vector3d::Zero();  // m/s
  double densest_ = 0;
  std::int64_t now_ns_;
  double due_ = 0;
  std::deque<Puff> alive_;
};

}  // namespace scree
