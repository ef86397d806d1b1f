#include "server/answers/room_tables.hpp"

#include <algorithm>

namespace liloc::answers {
namespace {

/// The number of a thing; a new one is added to the end.
template <class T>
std::uint32_t number_in(std::vector<const T*>& all, const T* one) {
  const auto at = std::ranges::find(all, one);
  const auto number = static_cast<std::uint32_t>(at - all.begin());
  if (at == all.end()) all.push_back(one);
  return number;
}

/// An image of the camera's size, or none at all.
template <class A, Of<DepthImage> V>
void fields(A& a, V& image, const Camera& camera) {
  numbers(a, image.stamp_ns);
  bool there = !image.units.empty();
  a.number(there);
  if (!there) return;
  if constexpr (A::kReads) {
    const std::size_t pixels = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    if (!a.holds(2 * pixels)) return;
    image.width = camera.width;
    image.height = camera.height;
    image.units.resize(pixels);
  }
  a.block(image.units.data(), 2 * image.units.size());
}

template <class A, Of<GlobalLidar> V>
void fields(A& a, V& lidar) {
  text(a, lidar.id);
  answers::fields(a, lidar.camera);
  a.number(lidar.rate_hz);
  answers::fields(a, lidar.T_map_sensor);
}

/// A number below `count`.
std::size_t number_below(ArchiveIn& in, std::size_t count) {
  std::uint32_t number = 0;
  in.number(number);
  in.require(number < count, "a number of something that is not there");
  return in.status() ? number : 0;
}

using Parts = std::vector<std::shared_ptr<const LidarSurfaces>>;
using Frames = std::vector<std::shared_ptr<const LidarFrame>>;

Parts read_surfaces(ArchiveIn& in, const std::deque<GlobalLidar>& lidars, const SnapshotOptions& options) {
  Parts all;
  for (std::size_t left = in.count(0, kMostLidars * kMostMoments); left > 0 && in.status(); --left) {
    const std::size_t lidar = number_below(in, lidars.size());
    if (!in.status()) break;
    DepthImage image;
    fields(in, image, lidars[lidar].camera);
    in.require(!image.units.empty(), "surfaces without an image");
    if (in.status())
      all.push_back(std::make_shared<const LidarSurfaces>(std::move(image), lidars[lidar], options));
  }
  return all;
}

Frames read_frames(ArchiveIn& in, const Parts& surfaces, const SnapshotOptions& options) {
  Frames all;
  for (std::size_t left = in.count(0, kMostLidars * kMostMoments); left > 0 && in.status(); --left) {
    const std::size_t part = number_below(in, surfaces.size());
    if (!in.status()) break;
    Layers layers;
    const GlobalLidar& lidar = surfaces[part]->lidar();
    fields(in, layers.still, lidar.camera);
    fields(in, layers.moving, lidar.camera);
    fields(in, layers.gone, lidar.camera);
    in.require(!layers.still.units.empty(), "a frame without an image");
    if (in.status())
      all.push_back(std::make_shared<const LidarFrame>(std::move(layers), surfaces[part], lidar, options));
  }
  return all;
}

std::shared_ptr<const StitchedRoom> room_of(const Frames& frames, const SnapshotOptions& options,
                                            std::vector<std::shared_ptr<const StitchedRoom>>& known) {
  StitchedRoom::Parts parts;
  for (const auto& frame : frames) parts.push_back(frame->surfaces());
  for (const auto& room : known)
    if (room->parts() == parts) return room;
  known.push_back(std::make_shared<const StitchedRoom>(std::move(parts), options));
  return known.back();
}

}  // namespace

void RoomsOut::write(ArchiveOut& out) {
  std::vector<const GlobalLidar*> lidars;
  std::vector<const LidarSurfaces*> surfaces;
  std::vector<const LidarFrame*> frames;
  for (const Snapshot* snapshot : snapshots_)
    for (const auto& frame : snapshot->frames()) {
      number_in(lidars, &frame->lidar());
      number_in(surfaces, frame->surfaces().get());
      number_in(frames, frame.get());
    }
  out.count(lidars.size(), kMostLidars);
  for (const GlobalLidar* lidar : lidars) fields(out, *lidar);
  out.count(surfaces.size(), kMostLidars * kMostMoments);
  for (const LidarSurfaces* part : surfaces) {
    out.number(number_in(lidars, &part->lidar()));
    fields(out, part->image(), part->lidar().camera);
  }
  out.count(frames.size(), kMostLidars * kMostMoments);
  for (const LidarFrame* frame : frames) {
    out.number(number_in(surfaces, frame->surfaces().get()));
    fields(out, frame->layers().still, frame->lidar().camera);
    fields(out, frame->layers().moving, frame->lidar().camera);
    fields(out, frame->layers().gone, frame->lidar().camera);
  }
  out.count(snapshots_.size(), kMostMoments);
  for (const Snapshot* snapshot : snapshots_) {
    out.count(snapshot->frames().size(), kMostLidars);
    for (const auto& frame : snapshot->frames()) out.number(number_in(frames, frame.get()));
  }
}

RoomsIn read_rooms(ArchiveIn& in, const SnapshotOptions& options) {
  RoomsIn rooms;
  for (std::size_t left = in.count(0, kMostLidars); left > 0 && in.status(); --left)
    fields(in, rooms.lidars->emplace_back());
  const Parts surfaces = read_surfaces(in, *rooms.lidars, options);
  const Frames frames = read_frames(in, surfaces, options);
  std::vector<std::shared_ptr<const StitchedRoom>> stitched;
  for (std::size_t left = in.count(0, kMostMoments); left > 0 && in.status(); --left) {
    Frames of_moment;
    for (std::size_t part = in.count(0, kMostLidars); part > 0 && in.status(); --part) {
      const std::size_t at = number_below(in, frames.size());
      if (in.status()) of_moment.push_back(frames[at]);
    }
    in.require(!of_moment.empty(), "a moment without a frame");
    if (!in.status()) break;
    auto room = room_of(of_moment, options, stitched);
    rooms.snapshots.push_back(std::make_shared<const Snapshot>(std::move(of_moment), std::move(room)));
  }
  return rooms;
}

}  // namespace liloc::answers
