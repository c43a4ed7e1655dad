#pragma once

#include <Eigen/Core>

#include "scree/core/point_cloud.hpp"

namespace scree {

/// Whether a cloud can have been seen from one place: the place lies above the ground, and hardly
/// any point lies behind another one. A cloud that was put together of many views was not, nor one
/// whose file gives the origin because nobody knew better. Allocates.
bool could_be_seen_from(const Eigen::Vector3f& viewpoint, PointView cloud);

}  // namespace scree
