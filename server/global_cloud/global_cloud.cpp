#include "server/global_cloud/global_cloud.hpp"

#include <algorithm>

namespace liloc {
namespace {

// A room's indices are some 20 MB, a snapshot 1 MB; by hand.
constexpr std::size_t kSnapshotsKept = 6, kRoomsKept = 3;
// So many rooms that sessions still look back at are no reason to make fewer; 160 MB. By hand.
constexpr std::size_t kRoomsAtEase = 8;
constexpr int kLateOnes = 3;  // in a row: it is not one bad stamp; by hand

// Once one was asked for; a crowded room is renewed every second; by hand.
constexpr int kRoomsDescribedAhead = 16;

StampNs gap(StampNs a, StampNs b) {
  return a > b ? a - b : b - a;
}

bool of_same_lidars(const StitchedRoom::Parts& a, const StitchedRoom::Parts& b) {
  const auto lidar = [](const auto& part) { return &part->lidar(); };
  return std::ranges::equal(a, b, {}, lidar, lidar);
}

}  // namespace

GlobalCloud::GlobalCloud(Site site, GlobalCloudOptions options)
    : site_(std::move(site)), options_(options), frames_(site_.global_lidars.size()) {
  for (const GlobalLidar& lidar : site_.global_lidars)
    watches_.emplace_back(Background(lidar.camera, options_.background));
}

Status GlobalCloud::add_depth(std::size_t lidar, DepthImage image) {
  if (lidar >= site_.global_lidars.size())
    return fail("LiDAR {} of {} does not exist", lidar, site_.global_lidars.size());
  const GlobalLidar& info = site_.global_lidars[lidar];
  if (image.width != info.camera.width || image.height != info.camera.height ||
      image.units.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    return fail("{}: depth image is {}x{} with {} values, the site says {}x{}", info.id, image.width,
                image.height, image.units.size(), info.camera.width, info.camera.height);
  Watch& watch = watches_[lidar];
  const std::scoped_lock in_turn(watch.mutex);
  if (watch.last_ns && image.stamp_ns <= *watch.last_ns && !clock_set_back(lidar, image.stamp_ns))
    return fail("{}: stamp {} is not newer than the last, {}", info.id, image.stamp_ns, *watch.last_ns);
  watch.last_ns = image.stamp_ns;
  keep(lidar, watched(lidar, std::move(image)));
  return {};
}

void GlobalCloud::set_known_noise(const std::vector<DepthNoise>& known) {
  for (std::size_t i = 0; i < std::min(known.size(), watches_.size()); ++i) {
    const std::scoped_lock in_turn(watches_[i].mutex);
    watches_[i].background = Background(site_.global_lidars[i].camera, options_.background, known[i]);
  }
}

std::vector<DepthNoise> GlobalCloud::noise() const {
  std::vector<DepthNoise> all;
  for (const Watch& watch : watches_) {
    const std::scoped_lock in_turn(watch.mutex);
    all.push_back(watch.background.noise());
  }
  return all;
}

void GlobalCloud::keep(std::size_t lidar, Frame frame) {
  const std::scoped_lock lock(mutex_);
  auto& frames = frames_[lidar];
  const StampNs oldest = frame->stamp_ns() - options_.keep_ns;
  frames.push_back(std::move(frame));
  while (frames.size() > options_.max_frames_per_lidar || frames.front()->stamp_ns() < oldest)
    frames.pop_front();
}

bool GlobalCloud::clock_set_back(std::size_t lidar, StampNs stamp_ns) {
  Watch& watch = watches_[lidar];
  const bool late = stamp_ns < *watch.last_ns - options_.keep_ns;
  watch.late = late ? watch.late + 1 : 0;
  if (watch.late < kLateOnes) return false;
  watch.background =
      Background(site_.global_lidars[lidar].camera, options_.background, watch.background.noise());
  watch.surfaces.reset();
  const std::scoped_lock lock(mutex_);
  frames_[lidar].clear();
  epoch_since_ns_ = std::min(epoch_since_ns_, stamp_ns);
  return true;
}

/// Of the room: a new one begins when small changes have gathered for long enough.
int GlobalCloud::epoch_after(Change change, StampNs stamp_ns) {
  const std::scoped_lock lock(mutex_);
  if (change == Change::small && stamp_ns - epoch_since_ns_ > options_.renew_ns) {
    ++epoch_;
    epoch_since_ns_ = stamp_ns;
  }
  return epoch_;
}

GlobalCloud::Frame GlobalCloud::watched(std::size_t lidar, DepthImage image) {
  const GlobalLidar& info = site_.global_lidars[lidar];
  Watch& watch = watches_[lidar];
  watch.late = 0;
  DepthImage moving;
  if (!options_.drop_moving) {
    watch.surfaces = std::make_shared<const LidarSurfaces>(image, info, options_.snapshot);
  } else {
    Layers layers = watch.background.learn(image);
    image = std::move(layers.still);
    moving = std::move(layers.moving);
    const Change change = watch.background.change();
    const int epoch = epoch_after(change, image.stamp_ns);
    if (!watch.surfaces || change == Change::large || watch.epoch != epoch) {
      watch.epoch = epoch;
      watch.surfaces =
          std::make_shared<const LidarSurfaces>(watch.background.surfaces(), info, options_.snapshot);
    }
  }
  return std::make_shared<const LidarFrame>(std::move(image), std::move(moving), watch.surfaces, info,
                                            options_.snapshot);
}

std::shared_ptr<const StitchedRoom> GlobalCloud::room_of(const std::vector<Frame>& frames) {
  StitchedRoom::Parts parts;
  for (const Frame& frame : frames) parts.push_back(frame->surfaces());
  for (const auto& room : rooms_)
    if (room->parts() == parts) return room;
  const StampNs stamp_ns = std::ranges::max(frames, {}, &LidarFrame::stamp_ns)->stamp_ns();
  std::erase_if(all_rooms_, [](const auto& room) { return room.expired(); });
  const auto crowding = static_cast<StampNs>(std::max<std::size_t>(1, all_rooms_.size() / kRoomsAtEase));
  const auto newest = std::find_if(rooms_.rbegin(), rooms_.rend(), [&](const auto& room) {
    return gap(room->stamp_ns(), stamp_ns) < crowding * options_.least_renewal_ns &&
           of_same_lidars(room->parts(), parts);
  });
  if (newest != rooms_.rend()) return *newest;
  rooms_.push_back(
      std::make_shared<const StitchedRoom>(std::move(parts), options_.snapshot, prepared_, stamp_ns));
  all_rooms_.push_back(rooms_.back());
  if (rooms_.size() > kRoomsKept) rooms_.pop_front();
  return rooms_.back();
}

Status GlobalCloud::add_points(std::size_t lidar, StampNs stamp_ns, const Cloud& cloud_sensor) {
  if (lidar >= site_.global_lidars.size())
    return fail("LiDAR {} of {} does not exist", lidar, site_.global_lidars.size());
  return add_depth(lidar, cloud_to_depth(cloud_sensor, site_.global_lidars[lidar].camera, stamp_ns));
}

GlobalCloud::Frame GlobalCloud::nearest_frame(std::size_t lidar, StampNs stamp_ns) const {
  Frame best;
  for (const Frame& frame : frames_[lidar])
    if (!best || gap(frame->stamp_ns(), stamp_ns) < gap(best->stamp_ns(), stamp_ns)) best = frame;
  return best && gap(best->stamp_ns(), stamp_ns) <= options_.match_ns ? best : nullptr;
}

std::shared_ptr<const Snapshot> GlobalCloud::snapshot_of(std::vector<Frame> frames) {
  const auto known = std::ranges::find(snapshots_, frames, &Snapshot::frames);
  if (known != snapshots_.end()) return *known;
  auto room = room_of(frames);
  snapshots_.push_back(std::make_shared<const Snapshot>(std::move(frames), std::move(room)));
  if (snapshots_.size() > kSnapshotsKept) snapshots_.pop_front();
  return snapshots_.back();
}

Result<std::shared_ptr<const Snapshot>> GlobalCloud::nearest(StampNs stamp_ns) {
  const std::scoped_lock lock(mutex_);
  std::vector<Frame> frames;
  StampNs newest = 0;
  for (std::size_t lidar = 0; lidar < frames_.size(); ++lidar) {
    if (!frames_[lidar].empty()) newest = std::max(newest, frames_[lidar].back()->stamp_ns());
    if (Frame frame = nearest_frame(lidar, stamp_ns)) frames.push_back(std::move(frame));
  }
  if (frames.empty())
    return newest == 0 ? fail("no ceiling LiDAR has sent a frame yet")
                       : fail("no ceiling frame within {:.0f} ms of the request; the newest is {:.0f} ms away",
                              to_ms(options_.match_ns), to_ms(newest - stamp_ns));
  return snapshot_of(std::move(frames));
}

bool GlobalCloud::worth_describing(const std::shared_ptr<const StitchedRoom>& room) {
  const auto asked = [](const auto& known) { return known->descriptors_asked(); };
  if (std::ranges::any_of(rooms_, asked))
    describe_ahead_ = kRoomsDescribedAhead;
  else if (room != prepared_ && describe_ahead_ > 0)
    --describe_ahead_;
  prepared_ = room;
  return describe_ahead_ > 0;
}

std::shared_ptr<const Snapshot> GlobalCloud::newest_held() {
  StampNs newest = 0;
  for (const auto& frames : frames_)
    if (!frames.empty()) newest = std::max(newest, frames.back()->stamp_ns());
  std::vector<Frame> frames;
  for (const auto& held : frames_)
    if (!held.empty() && held.back()->stamp_ns() > newest - 2 * options_.match_ns)
      frames.push_back(held.back());
  return frames.empty() ? nullptr : snapshot_of(std::move(frames));
}

std::shared_ptr<const Snapshot> GlobalCloud::newest() {
  const std::scoped_lock lock(mutex_);
  return newest_held();
}

void GlobalCloud::prepare() {
  std::shared_ptr<const Snapshot> snapshot;
  bool describe = false;
  {
    const std::scoped_lock lock(mutex_);
    snapshot = newest_held();
    if (!snapshot) return;
    describe = worth_describing(snapshot->room());
  }
  snapshot->room()->prepare(describe);
  (void)snapshot->target();
}

}  // namespace liloc
