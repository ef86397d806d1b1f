#include "server/global_cloud/snapshot.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/base/log.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"
#include "common/registration/search/up.hpp"

namespace liloc {
namespace {

constexpr double kMovingVoxel_m = 0.15, kGoneVoxel_m = 0.05;  // by hand

// Of the depth: means that differ by more are not the same surface; by hand, by far over what they tremble.
constexpr float kOtherSurface = 0.03F;

Cloud thinned_map(const DepthImage& image, const GlobalLidar& lidar, const DepthOptions& depth,
                  double voxel_m) {
  if (image.units.empty()) return {};
  const auto cloud_sensor = depth_to_cloud(image, lidar.camera, depth);
  if (cloud_sensor) return transformed(lidar.T_map_sensor, voxel_downsample(*cloud_sensor, voxel_m));
  log::error("{}: {}", lidar.id, cloud_sensor.error().message);
  return {};
}

SightView view_of(const DepthImage& image, const GlobalLidar& lidar, const SnapshotOptions& options) {
  return SightView::from_depth(image, lidar.camera, lidar.T_map_sensor.inverse(), options.view_factor,
                               options.depth.max_range_m);
}

}  // namespace

LidarSurfaces::LidarSurfaces(DepthImage image, const GlobalLidar& lidar, const SnapshotOptions& options)
    : image_(std::move(image)), lidar_(lidar), options_(options) {}

const Cloud& LidarSurfaces::cloud_map() const {
  std::call_once(once_, [this] {
    const auto cloud_sensor = depth_to_cloud(image_, lidar_.camera, options_.depth);
    if (!cloud_sensor) return log::error("{}: {}", lidar_.id, cloud_sensor.error().message);
    const Cloud thin = with_normals(voxel_downsample(*cloud_sensor, options_.voxel_size_m),
                                    Eigen::Vector3f::Zero(), {2.5 * options_.voxel_size_m, 5});
    cloud_map_ = transformed(lidar_.T_map_sensor, thin);
  });
  return cloud_map_;
}

Cloud LidarSurfaces::missing_of(const LidarSurfaces& before) const {
  DepthImage missing = before.image_;
  for (std::size_t i = 0; i < missing.units.size(); ++i) {
    const float was = missing.units[i], is = image_.units[i];
    if (is > 0 && is - was <= kOtherSurface * was) missing.units[i] = 0;
  }
  return thinned_map(missing, lidar_, options_.depth, kGoneVoxel_m);
}

SightView LidarSurfaces::view() const {
  return view_of(image_, lidar_, options_);
}

LidarFrame::LidarFrame(Layers layers, std::shared_ptr<const LidarSurfaces> surfaces, const GlobalLidar& lidar,
                       const SnapshotOptions& options)
    : layers_(std::move(layers)), surfaces_(std::move(surfaces)), lidar_(lidar), options_(options) {}

const SightView& LidarFrame::view() const {
  std::call_once(once_, [this] { view_ = view_of(layers_.still, lidar_, options_); });
  return view_;
}

const Cloud& LidarFrame::moving_map() const {
  std::call_once(moving_once_,
                 [this] { moving_map_ = thinned_map(layers_.moving, lidar_, options_.depth, kMovingVoxel_m); });
  return moving_map_;
}

const Cloud& LidarFrame::gone_map() const {
  std::call_once(gone_once_,
                 [this] { gone_map_ = thinned_map(layers_.gone, lidar_, options_.depth, kGoneVoxel_m); });
  return gone_map_;
}

const std::shared_ptr<const Surfaces>& StitchedRoom::surfaces() const {
  std::call_once(surfaces_once_, [this] {
    Cloud stitched;
    std::vector<SightView> views;
    for (const auto& part : parts_) {
      append(stitched, part->cloud_map());
      views.push_back(part->view());
    }
    const auto before = before_.lock();
    surfaces_ = std::make_shared<const Surfaces>(
        voxel_downsample(stitched, options_.voxel_size_m), std::move(views), options_.voxel_size_m,
        before && before->has_surfaces_ ? before->surfaces_.get() : nullptr);
    has_surfaces_ = true;
  });
  return surfaces_;
}

const Described& StitchedRoom::described() const {
  std::call_once(described_once_, [this] {
    DescribeOptions describing{10 * options_.voxel_size_m, options_.feature_sampling, 1};
    describing.describer = options_.describer;
    describing.up = up_map();
    described_ = describe(surfaces()->coarse, describing, &surfaces()->cloud);
    has_descriptors_ = true;
  });
  return described_;
}

const Eigen::Vector3d& StitchedRoom::up_map() const {
  std::call_once(up_once_, [this] {
    Eigen::Vector3d expected = Eigen::Vector3d::Zero();  // hung upright, looking level to straight down
    for (const auto& part : parts_)
      expected += part->lidar().T_map_sensor.linear() * Eigen::Vector3d(0, -1, -0.5);
    up_map_ = up_of_map(surfaces()->coarse, expected);
  });
  return up_map_;
}

void StitchedRoom::prepare(bool describe) const {
  if (surfaces()->cloud.empty()) return;
  (void)surfaces()->field_fine();
  (void)up_map();
  if (describe) (void)described();
}

StampNs Snapshot::stamp_near(StampNs stamp_ns) const {
  const auto away = [&](const auto& frame) { return std::abs(frame->stamp_ns() - stamp_ns); };
  return (*std::ranges::min_element(frames_, {}, away))->stamp_ns();
}

const Target& Snapshot::target() const {
  std::call_once(once_, [this] {
    target_.surfaces = room_->surfaces();
    Cloud moving_map, gone_map;
    for (const auto& frame : frames_) {
      target_.views.push_back(frame->view());
      append(moving_map, frame->moving_map());
      append(gone_map, frame->gone_map());
    }
    for (const auto& part : room_->parts())
      for (const auto& frame : frames_)
        if (&frame->lidar() == &part->lidar() && frame->surfaces() != part)
          append(gone_map, frame->surfaces()->missing_of(*part));
    target_.dynamic =
        std::make_shared<const DynamicRegions>(target_.surfaces, target_.views, moving_map, gone_map);
    has_target_ = true;
  });
  return target_;
}

}  // namespace liloc
