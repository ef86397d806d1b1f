#pragma once
// The bridge to PCL's types, for tools that read its files and tests that trust its algorithms.
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include "common/geometry/cloud.hpp"

namespace liloc {

[[nodiscard]] pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const Cloud& cloud);
[[nodiscard]] pcl::PointCloud<pcl::Normal>::Ptr normals_to_pcl(const Cloud& cloud);
/// Drops non-finite points, which PCL's kd-trees assert on.
[[nodiscard]] Cloud from_pcl(const pcl::PointCloud<pcl::PointXYZ>& cloud);

}  // namespace liloc
