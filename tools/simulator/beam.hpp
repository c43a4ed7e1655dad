#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scree/core/fixed_vector.hpp"
#include "scree/core/random.hpp"
#include "simulator/movers.hpp"
#include "simulator/ray_caster.hpp"
#include "simulator/terrain.hpp"

namespace scree {

/// Light that comes back from one distance.
struct Echo {
  double range = 0;         ///< metres
  double light = 0;         ///< received, against the receiver's threshold
  double reflectivity = 0;  ///< 0..255
  float relief = 0;         ///< what features add to the ground where it was hit, metres
  std::uint16_t part = 0;   ///< of the feature hit more than 5 cm above or below ground, or of
                            ///< the edge hit; 0 for none
};

/// A laser's beam, which is no line: 3.0 mrad wide and 1.5 mrad high (VLP-16, divergence). What it
/// meets at several distances comes back as several echoes; what lies closer together than a
/// pulse is long blends into one between them, which makes mixed pixels at edges. Blades
/// of tufts throw back a part of the light and let the rest pass.
class Beam {
public:
  static constexpr std::size_t kMostEchoes = 5;

  /// Keeps references to terrain and caster.
  Beam(const Terrain& terrain, const RayCaster& caster, double reach)
      : terrain_(terrain), caster_(caster), reach_(reach), echoes_(kMostEchoes) {}
  /// Keeps a reference: they may stand in the way, too.
  void add(const PlacedMovers& movers) { movers_ = &movers; }

  /// Echoes from the nearest to the farthest, in the threshold's units; none from the sky.
  /// @param left, up across the direction; all three have length 1
  const FixedVector<Echo>& cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                const Eigen::Vector3d& left, const Eigen::Vector3d& up,
                                Random& random);

private:
  bool add(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double share,
           Random& random);
  void blend();

  const Terrain& terrain_;
  const RayCaster& caster_;
  const PlacedMovers* movers_ = nullptr;
  double reach_;
  FixedVector<Echo> echoes_;
};

}  // namespace scree
