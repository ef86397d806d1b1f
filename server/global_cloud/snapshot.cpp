#include "server/global_cloud/snapshot.hpp"

#include "common/base/log.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/normals.hpp"

namespace liloc {

LidarFrame::LidarFrame(DepthImage image, const GlobalLidar& lidar, const SnapshotOptions& options)
    : image_(std::move(image)), lidar_(lidar), options_(options) {}

void LidarFrame::derive() const {
  view_ = SightView::from_depth(image_, lidar_.camera, lidar_.T_map_sensor.inverse(), options_.view_factor,
                                options_.depth.max_range_m);
  const auto cloud_sensor = depth_to_cloud(image_, lidar_.camera, options_.depth);
  if (!cloud_sensor) return log::error("{}: {}", lidar_.id, cloud_sensor.error().message);
  const Cloud thin = with_normals(voxel_downsample(*cloud_sensor, options_.voxel_size_m), Eigen::Vector3f::Zero(),
                                  {2.5 * options_.voxel_size_m, 5});
  cloud_map_ = transformed(lidar_.T_map_sensor, thin);
}

const Cloud& LidarFrame::cloud_map() const {
  std::call_once(once_, [this] { derive(); });
  return cloud_map_;
}

const SightView& LidarFrame::view() const {
  std::call_once(once_, [this] { derive(); });
  return view_;
}

Snapshot::Snapshot(StampNs stamp_ns, std::vector<std::shared_ptr<const LidarFrame>> frames,
                   const SnapshotOptions& options)
    : stamp_ns_(stamp_ns), frames_(std::move(frames)), options_(options) {}

const Target& Snapshot::target() const {
  std::call_once(target_once_, [this] {
    Cloud stitched;
    std::vector<SightView> views;
    for (const auto& frame : frames_) {
      append(stitched, frame->cloud_map());
      views.push_back(frame->view());
    }
    target_ = make_target(voxel_downsample(stitched, options_.voxel_size_m), std::move(views),
                          options_.voxel_size_m);
  });
  return target_;
}

const Described& Snapshot::described() const {
  std::call_once(described_once_, [this] {
    described_ = describe(target().coarse, {10 * options_.voxel_size_m, options_.feature_sampling, 1});
  });
  return described_;
}

}  // namespace liloc
