#include "common/geometry/pcl.hpp"

namespace liloc {

pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const Cloud& cloud) {
  auto result = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  result->reserve(cloud.size());
  for (const auto& p : cloud.points) result->emplace_back(p.x(), p.y(), p.z());
  return result;
}

pcl::PointCloud<pcl::Normal>::Ptr normals_to_pcl(const Cloud& cloud) {
  auto result = std::make_shared<pcl::PointCloud<pcl::Normal>>();
  result->reserve(cloud.normals.size());
  for (const auto& n : cloud.normals) result->emplace_back(n.x(), n.y(), n.z());
  return result;
}

Cloud from_pcl(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  Cloud result;
  result.points.reserve(cloud.size());
  for (const auto& p : cloud)
    if (p.getVector3fMap().allFinite()) result.points.push_back(p.getVector3fMap());
  return result;
}

}  // namespace liloc
