#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstddef>
#include <memory>

#include "scree/core/point_cloud.hpp"

namespace scree {

/// The points of a pcl::PointCloud of any point type that has x, y and z. Their reflectivity is
/// `intensity` where the type has it, else 0. Only who includes this needs PCL.
template <class Point>
PointCloud from_pcl(const pcl::PointCloud<Point>& cloud) {
  PointCloud points(cloud.size());
  for (const Point& point : cloud) {
    if constexpr (requires { point.intensity; }) {
      points.push_back(point.x, point.y, point.z, static_cast<float>(point.intensity));
    } else {
      points.push_back(point.x, point.y, point.z, 0.0F);
    }
  }
  return points;
}

/// The other way: the reflectivity becomes `intensity`.
inline pcl::PointCloud<pcl::PointXYZI>::Ptr to_pcl(PointView cloud) {
  auto result = std::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  result->reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    result->push_back({cloud.x[i], cloud.y[i], cloud.z[i], cloud.reflectivity[i]});
  }
  return result;
}

}  // namespace scree
